/* The loop from feedback to sharp texels: shaders sample the source's content. */
#include "device/scene.h"

#include "base/checked.h"
#include "support/map_everything.h"
#include "support/roll.h"
#include "support/test.h"

#include <sluice/vulkan_control.h>

#include <math.h>
#include <string.h>

static const SluiceFormat formats[] = {
    SLUICE_FORMAT_R8_UNORM,   SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_R8G8B8A8_SRGB,
    SLUICE_FORMAT_R16_SFLOAT, SLUICE_FORMAT_R16G16_SFLOAT,  SLUICE_FORMAT_R16G16B16A16_SFLOAT,
    SLUICE_FORMAT_R32_SFLOAT, SLUICE_FORMAT_R32G32_SFLOAT,  SLUICE_FORMAT_R32G32B32A32_SFLOAT,
};
#define FORMATS (sizeof formats / sizeof formats[0])

static const struct scene_aim everywhere = {0, 0, 1, 1, 0, 7, 0, 0};

static void settled_sample_shows_the_level_that_was_wanted(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 100});
    uint32_t t =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM));
    roll_seed(1);
    scene_aim(&scene, t, SCENE_SAMPLES, &everywhere);
    scene_settle(&scene, 14);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++) {
        const struct ProbeOutput *out = &scene_outputs(&scene, t)[i];
        assert_int_equal(out->missingLevels, 0);
        assert_float_equal(pattern_level(out->color), out->lod, 0.15);
    }
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

/* First the fallback color, then coarse levels, then finer ones, and never coarser ones again. */
static void picture_gets_sharper_frame_by_frame(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 100,
                                         .tilesPerFrame = 8});
    uint32_t t =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM));
    const struct scene_aim fine = {0, 0, 1, 1, 0.2, 0.3, 0, 0};
    scene_aim(&scene, t, 64, &fine);
    uint32_t levels[64], steps = 0;
    harness_frame(scene.h, scene.streamer, true, scene_record, &scene);
    for (uint32_t i = 0; i < 64; i++) {
        levels[i] = scene_outputs(&scene, t)[i].level;
        assert_int_equal(levels[i], SLUICE_MIP_UNTOUCHED);
        assert_float_equal(scene_outputs(&scene, t)[i].color[0], 0.5, 0);
    }
    for (uint32_t frame = 0; frame < 60; frame++) {
        scene_settle(&scene, 1);
        for (uint32_t i = 0; i < 64; i++) {
            assert_true(scene_outputs(&scene, t)[i].level <= levels[i]);
            steps += scene_outputs(&scene, t)[i].level < levels[i];
            levels[i] = scene_outputs(&scene, t)[i].level;
        }
    }
    assert_int_equal(scene_missing(&scene), 0);
    assert_true(steps > 64 * 2);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

static void check_fetched(const struct scene_texture *texture, const struct ProbeInput *in,
                          const struct ProbeOutput *out)
{
    SluiceFormat format = texture->info.format;
    uint32_t level = (uint32_t)in->lodBias, x = (uint32_t)in->uv[0], y = (uint32_t)in->uv[1];
    float rgba[4];
    pattern_texel(PATTERN_HASH, level, x, y, rgba);
    for (uint32_t c = 0; c < pattern_channel_count(format); c++)
        if (!(fabsf(out->color[c] - rgba[c]) <= pattern_tolerance(format)))
            fail_msg("%ux%u %s: level %u (%u, %u) channel %u is %.9g, not %.9g",
                     texture->info.width, texture->info.height, sluiceGetFormatName(format), level,
                     x, y, c, (double)out->color[c], (double)rgba[c]);
}

struct fetch {
    struct scene *scene;
    uint32_t texture, count;
};

static void record_fetch(void *user, VkCommandBuffer commands)
{
    struct fetch *fetch = user;
    prober_record(&fetch->scene->prober, commands, fetch->scene->textures[fetch->texture].probe, 0,
                  fetch->count, PROBE_FETCH);
}

static void fetch_and_check(struct fetch *fetch)
{
    harness_run(fetch->scene->h, record_fetch, fetch);
    for (uint32_t i = 0; i < fetch->count; i++)
        check_fetched(&fetch->scene->textures[fetch->texture],
                      &prober_inputs(&fetch->scene->prober)[i],
                      &prober_outputs(&fetch->scene->prober)[i]);
    fetch->count = 0;
}

/* Fetches all texels of small levels, every `stride`th of large ones, and all edges of tiles. */
static void fetch_all(struct scene *scene, uint32_t index, uint32_t stride)
{
    const struct scene_texture *texture = &scene->textures[index];
    struct fetch fetch = {scene, index, 0};
    uint32_t n = 0;
    for (uint32_t level = 0; level < texture->info.mipLevelCount; level++) {
        uint32_t width = slc_mip_size(texture->info.width, level);
        uint32_t height = slc_mip_size(texture->info.height, level);
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++) {
                bool edge = x % 64 == 0 || x % 64 == 63 || y % 64 == 0 || y % 64 == 63;
                if (width * height > 4096 && ++n % (edge ? stride : 16 * stride) != 0)
                    continue;
                prober_inputs(&scene->prober)[fetch.count++] =
                    (struct ProbeInput){.uv = {(float)x, (float)y}, .lodBias = (float)level};
                if (fetch.count == PROBE_CAPACITY)
                    fetch_and_check(&fetch);
            }
    }
    fetch_and_check(&fetch);
}

static void every_texel_is_where_the_source_has_it(void **state)
{
    const uint32_t sizes[][2] = {{600, 300}, {1, 1},      {257, 129}, {128, 128}, {1, 700},
                                 {900, 1},   {1031, 517}, {64, 2048}, {8192, 128}};
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .pDebug = &map_everything});
    uint32_t expected = 0;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
        for (size_t f = s % 3; f < FORMATS; f += 3, expected++)
            scene_add(&scene, pattern_source(PATTERN_HASH, sizes[s][0], sizes[s][1], formats[f]));
    scene_settle(&scene, 16);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_int_equal(stats.mappedTileCount, stats.tileCount);
    for (uint32_t i = 0; i < expected; i++)
        fetch_all(&scene, i, 3);
    scene_finish(&scene);
}

/* Equal samples with everything resident give equal bits. */
static void settled_colors_are_those_of_a_resident_texture(void **state)
{
    static struct ProbeOutput truth[PROBE_CAPACITY];
    for (int streamed = 0; streamed < 2; streamed++) {
        struct scene scene;
        scene_init(
            &scene, *state,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .feedbackTimeoutTicks = 1000,
                                             .pDebug = streamed ? NULL : &map_everything});
        roll_seed(2);
        const uint32_t sizes[][2] = {{1024, 1024}, {1000, 600}, {777, 1311}, {2048, 100}};
        for (uint32_t i = 0; i < 12; i++) {
            float anisotropy = i % 3 == 2 ? 8.0f : 1.0f;
            uint32_t t = scene_add_as(&scene,
                                      pattern_source(PATTERN_HASH, sizes[i % 4][0], sizes[i % 4][1],
                                                     formats[i % FORMATS]),
                                      i % 5, (i + 2) % 4, anisotropy, SLUICE_NO_TEXTURE);
            const struct scene_aim aim = {
                -0.5, -0.5, 2, 2, -1, 9, i % 2 ? 10 : 0, i % 4 == 3 ? -0.75f : 0.0f};
            scene_aim(&scene, t, SCENE_SAMPLES, &aim);
        }
        scene_settle(&scene, 20);
        assert_int_equal(scene_missing(&scene), 0);
        assert_int_equal(scene_non_resident(&scene), 0);
        if (!streamed)
            memcpy(truth, prober_outputs(&scene.prober), sizeof truth);
        else
            for (uint32_t t = 0; t < 12; t++)
                for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
                    assert_memory_equal(scene_outputs(&scene, t)[i].color,
                                        truth[t * SCENE_SAMPLES + i].color, 4 * sizeof(float));
        scene_finish(&scene);
    }
}

static void tiles_nobody_wants_any_more_are_unmapped_and_come_back_right(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 3});
    uint32_t t =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, SLUICE_FORMAT_R8G8B8A8_UNORM));
    const struct scene_aim left = {0.02, 0.02, 0.4, 0.9, 0.3, 0.4, 0, 0};
    const struct scene_aim right = {0.55, 0.02, 0.4, 0.9, 0.3, 0.4, 0, 0};
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    for (int turn = 0; turn < 4; turn++) {
        scene_aim(&scene, t, SCENE_SAMPLES, turn % 2 ? &right : &left);
        scene_settle(&scene, 16);
        assert_int_equal(scene_missing(&scene), 0);
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            assert_float_equal(pattern_level(scene_outputs(&scene, t)[i].color),
                               scene_outputs(&scene, t)[i].lod, 0.15);
        sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
        /* half of level 0 is 128 tiles, of level 1 32, and so on */
        assert_in_range(stats.mappedTileCount, 100, 200);
        assert_int_equal(stats.standbyTileCount, 0);
    }
    assert_true(stats.tilesUnmapped > 300);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

static void followers_get_what_their_primary_wants(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    uint32_t primary =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM));
    uint32_t follower = scene_add_as(
        &scene, pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R16G16B16A16_SFLOAT), 0, 0,
        1, scene.textures[primary].texture.textureId);
    roll_seed(3);
    const struct scene_aim aim = {0.1, 0.1, 0.35, 0.35, 0, 4, 0, 0};
    scene_aim(&scene, primary, SCENE_SAMPLES, &aim);
    memcpy(scene_inputs(&scene, follower), scene_inputs(&scene, primary),
           SCENE_SAMPLES * sizeof(struct ProbeInput));
    scene.textures[follower].sample_count = SCENE_SAMPLES;
    scene.textures[follower].no_feedback = true;
    scene_settle(&scene, 16);
    assert_int_equal(scene_missing(&scene), 0);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
        assert_float_equal(pattern_level(scene_outputs(&scene, follower)[i].color),
                           scene_outputs(&scene, follower)[i].lod, 0.15);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

/* The texels of a pattern with another alpha. */
struct faint {
    SluiceImageSource base;
    SluiceImageSource *inner;
};

static SluiceResult faint_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct faint *)source)->inner, info);
}

static SluiceResult faint_read(SluiceImageSource *source, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch)
{
    SluiceResult result =
        sluiceReadImageRegion(((struct faint *)source)->inner, region, texels, row_pitch);
    for (uint32_t y = 0; y < region->height; y++)
        for (uint32_t x = 0; x < region->width; x++)
            ((uint8_t *)texels)[y * row_pitch + 4 * (size_t)x + 3] = 51;
    return result;
}

static void faint_destroy(SluiceImageSource *source)
{
    (void)source;
}

static const SluiceImageSourceInterface faint_interface = {sizeof faint_interface, faint_info,
                                                           faint_read, faint_destroy, NULL};

/* No sample gets coarser, and in the end all texels are new. */
static void replaced_texels_come_without_a_coarser_picture(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    uint32_t t =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 1024, 512, SLUICE_FORMAT_R8G8B8A8_UNORM));
    const SluiceTextureId id = scene.textures[t].texture.textureId;
    struct faint faint = {{&faint_interface}, scene.textures[t].source};
    SluiceVulkanTextureState now = {.structSize = sizeof now};
    roll_seed(4);
    scene_aim(&scene, t, SCENE_SAMPLES, &everywhere);
    scene_settle(&scene, 14);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
        assert_float_equal(scene_outputs(&scene, t)[i].color[3], 1.0, 0.001);
    CHECK_OK(sluiceReplaceVulkanSource(scene.streamer, id, &faint.base));
    for (uint32_t frame = 0; frame == 0 || now.reloadingTileCount > 0; frame++) {
        assert_true(frame < 100);
        scene_settle(&scene, 1);
        scene_check_levels(&scene);
        assert_int_equal(scene_missing(&scene), 0);
        CHECK_OK(sluiceGetVulkanTextureState(scene.streamer, id, NULL, &now));
    }
    scene_settle(&scene, 1);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
        assert_float_equal(scene_outputs(&scene, t)[i].color[3], 0.2, 0.001);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(settled_sample_shows_the_level_that_was_wanted),
        cmocka_unit_test(picture_gets_sharper_frame_by_frame),
        cmocka_unit_test(every_texel_is_where_the_source_has_it),
        cmocka_unit_test(settled_colors_are_those_of_a_resident_texture),
        cmocka_unit_test(tiles_nobody_wants_any_more_are_unmapped_and_come_back_right),
        cmocka_unit_test(followers_get_what_their_primary_wants),
        cmocka_unit_test(replaced_texels_come_without_a_coarser_picture),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
