/* Texels that commands of the application write, and what shaders fetch of them. */
#include "device/maker.h"
#include "device/scene.h"

#include "base/checked.h"
#include "support/map_everything.h"
#include "support/test.h"

#include <math.h>

enum { WIDTH = 1500, HEIGHT = 700, LEVELS = 11 };

static const struct scene_aim all_levels = {0, 0, 1, 1, -1, 10, 0, 0};

static SluiceImageInfo image_info(SluiceFormat format)
{
    return (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                             .width = WIDTH,
                             .height = HEIGHT,
                             .format = format,
                             .pName = "made pattern"};
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

static void check_fetched(struct fetch *fetch)
{
    const struct prober *prober = &fetch->scene->prober;
    float tolerance = pattern_tolerance(fetch->scene->textures[fetch->texture].info.format);
    harness_run(fetch->scene->h, record_fetch, fetch);
    for (uint32_t i = 0; i < fetch->count; i++) {
        const struct ProbeInput *in = &prober_inputs(&fetch->scene->prober)[i];
        const float *color = prober_outputs(prober)[i].color;
        float expected[4];
        pattern_texel(PATTERN_HASH, (uint32_t)in->lodBias, (uint32_t)in->uv[0], (uint32_t)in->uv[1],
                      expected);
        for (uint32_t c = 0; c < 4; c++)
            if (fabsf(color[c] - expected[c]) > fmaxf(1e-6f, tolerance))
                fail_msg("level %g (%g, %g) channel %u is %g, not %g", (double)in->lodBias,
                         (double)in->uv[0], (double)in->uv[1], c, (double)color[c],
                         (double)expected[c]);
    }
    fetch->count = 0;
}

/* Every texel of levels from 2 on, and every seventh of the others, which meets all tiles. */
static void check_texels(struct scene *scene, uint32_t texture)
{
    struct fetch fetch = {scene, texture, 0};
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t y = 0; y < slc_mip_size(HEIGHT, level); y += level < 2 ? 7 : 1)
            for (uint32_t x = 0; x < slc_mip_size(WIDTH, level); x += level < 2 ? 7 : 1) {
                prober_inputs(&scene->prober)[fetch.count++] =
                    (struct ProbeInput){.uv = {(float)x, (float)y}, .lodBias = (float)level};
                if (fetch.count == PROBE_CAPACITY)
                    check_fetched(&fetch);
            }
    check_fetched(&fetch);
}

static SluiceVulkanStreamerStatistics statistics(const struct scene *scene)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(scene->streamer, &stats));
    return stats;
}

static SluiceVulkanStreamerCreateInfo everything(void)
{
    return (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                            .pDebug = &map_everything};
}

/* All tiles and levels of a produced texture have the right texels. */
static void check_made(struct harness *h, struct maker *maker, SluiceFormat format)
{
    const SluiceImageInfo image = image_info(format);
    const SluiceTileProducer producer = maker_producer(maker, &image);
    struct scene scene;
    scene_init(&scene, h, everything());
    uint32_t made = scene_add_produced(&scene, &producer);
    scene_settle(&scene, 40);
    SluiceVulkanStreamerStatistics stats = statistics(&scene);
    assert_int_equal(stats.mappedTileCount, stats.tileCount);
    assert_int_equal(stats.bytesRead, 0);
    assert_true(stats.tilesProduced > 50);
    check_texels(&scene, made);
    scene_finish(&scene);
}

static void texels_are_what_a_shader_stored(void **state)
{
    struct maker maker;
    maker_init(&maker, *state, NULL);
    check_made(*state, &maker, SLUICE_FORMAT_R8G8B8A8_UNORM);
    maker_finish(&maker);
}

/* A format that shaders cannot store to. */
static void texels_are_what_a_command_copied(void **state)
{
    struct maker maker;
    SluiceImageSource *source =
        pattern_source(PATTERN_HASH, WIDTH, HEIGHT, SLUICE_FORMAT_R8G8B8A8_SRGB);
    maker_init(&maker, *state, source);
    check_made(*state, &maker, SLUICE_FORMAT_R8G8B8A8_SRGB);
    maker_finish(&maker);
    sluiceDestroyImageSource(source);
}

static void tiles_come_though_some_are_late_and_some_fail_at_first(void **state)
{
    struct harness *h = *state;
    struct maker maker;
    maker_init(&maker, h, NULL);
    maker.unready_one_in = 3;
    maker.failing_one_in = 7;
    h->quiet = true;
    check_made(h, &maker, SLUICE_FORMAT_R8G8B8A8_UNORM);
    h->quiet = false;
    maker_finish(&maker);
}

static void tiles_of_abandoned_frames_are_made_again(void **state)
{
    struct harness *h = *state;
    struct maker maker;
    maker_init(&maker, h, NULL);
    h->abandon_one_in = 2;
    check_made(h, &maker, SLUICE_FORMAT_R8G8B8A8_UNORM);
    h->abandon_one_in = 0;
    maker_finish(&maker);
}

/* Made only where samples are; beside textures that are read, which come and go. */
static void tiles_are_made_where_samples_are(void **state)
{
    struct harness *h = *state;
    struct maker maker;
    struct scene scene;
    const SluiceImageInfo image = image_info(SLUICE_FORMAT_R8G8B8A8_UNORM);
    const struct scene_aim corner = {0.02, 0.02, 0.05, 0.05, -1, 3, 0, 0};
    maker_init(&maker, h, NULL);
    const SluiceTileProducer producer = maker_producer(&maker, &image);
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 4,
                                         .tilesPerFrame = 8});
    for (uint32_t round = 0; round < 3; round++) {
        uint32_t read = scene_add(
            &scene, pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM));
        uint32_t made = scene_add_produced(&scene, &producer);
        scene_aim(&scene, read, 200, &all_levels);
        scene_aim(&scene, made, 200, round == 0 ? &corner : &all_levels);
        for (uint32_t i = 0; i < 9; i++)
            harness_frame(h, scene.streamer, i % 3 == 0, scene_record, &scene);
        if (round == 1) { /* in the middle of it */
            scene_remove(&scene, made);
            scene_remove(&scene, read);
            continue;
        }
        scene_settle(&scene, 40);
        assert_int_equal(scene_missing(&scene), 0);
        if (round == 0)
            assert_true(statistics(&scene).tilesProduced < 8);
        scene_remove(&scene, made);
        scene_remove(&scene, read);
    }
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
    maker_finish(&maker);
}

/* A removed texture leaves places in its chunk of pages, which those of the other one fill. */
static void texels_stay_where_memory_is_compacted(void **state)
{
    struct harness *h = *state;
    struct maker maker;
    struct scene scene;
    const SluiceImageInfo image = image_info(SLUICE_FORMAT_R8G8B8A8_UNORM);
    maker_init(&maker, h, NULL);
    const SluiceTileProducer producer = maker_producer(&maker, &image);
    scene_init(&scene, h, everything());
    uint32_t first = scene_add_produced(&scene, &producer);
    scene_settle(&scene, 40);
    uint32_t second = scene_add_produced(&scene, &producer);
    scene_settle(&scene, 40);
    scene_remove(&scene, first);
    for (uint32_t i = 0; i < 8; i++)
        harness_frame(h, scene.streamer, true, NULL, NULL);
    uint32_t moved = 0;
    for (uint32_t i = 0; i < 60; i++) {
        uint32_t count = 0;
        CHECK_OK(sluiceCompactVulkanStreamer(scene.streamer, 64, &count));
        moved += count;
        harness_frame(h, scene.streamer, true, NULL, NULL);
    }
    if (h->mode == SLUICE_RESIDENCY_MODE_PAGED)
        assert_true(moved > 0);
    check_texels(&scene, second);
    scene_finish(&scene);
    maker_finish(&maker);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_stay_where_memory_is_compacted),
        cmocka_unit_test(texels_are_what_a_shader_stored),
        cmocka_unit_test(texels_are_what_a_command_copied),
        cmocka_unit_test(tiles_come_though_some_are_late_and_some_fail_at_first),
        cmocka_unit_test(tiles_of_abandoned_frames_are_made_again),
        cmocka_unit_test(tiles_are_made_where_samples_are),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
