/* Every format, from its source through staging memory and bindings to a shader's fetch. */
#include "device/blocks.h"
#include "device/cut_source.h"
#include "device/scene.h"

#include "base/checked.h"
#include "image/convert.h"
#include "image/format_size.h"
#include "support/map_everything.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

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

/* Reads the texel from the source. Conversions have tests of their own. */
static void texel_of_source(const struct scene_texture *texture, const SluiceImageRegion *region,
                            float rgba[4])
{
    char texel[16];
    CHECK_OK(sluiceReadImageRegion(texture->source, region, texel, sizeof texel));
    slc_texels_to_rgba(texture->info.format, texel, rgba, 1);
}

static struct block_range expected_range(const struct scene_texture *texture,
                                         const SluiceImageRegion *region)
{
    SluiceFormat format = texture->info.format;
    if (sluiceGetFormatTexelSize(format) == 0)
        return block_texel(format, region->mipLevel, region->x, region->y);
    float expected[4];
    texel_of_source(texture, region, expected);
    /* divisions by 255, 1023 and 3 may be products */
    float tolerance = fmaxf(1e-6f, pattern_tolerance(format));
    struct block_range range;
    for (uint32_t c = 0; c < 4; c++) {
        range.low[c] = expected[c] - tolerance * fmaxf(1, fabsf(expected[c]));
        range.high[c] = expected[c] + tolerance * fmaxf(1, fabsf(expected[c]));
    }
    return range;
}

static void check_fetched(const struct scene_texture *texture, const struct ProbeInput *in,
                          const struct ProbeOutput *out)
{
    SluiceImageRegion region = {(uint32_t)in->lodBias, (uint32_t)in->uv[0], (uint32_t)in->uv[1], 1,
                                1};
    struct block_range range = expected_range(texture, &region);
    for (uint32_t c = 0; c < 4; c++)
        if (!(out->color[c] >= range.low[c] && out->color[c] <= range.high[c]))
            fail_msg("%ux%u %s: level %u (%u, %u) channel %u is %.9g, not %.9g to %.9g",
                     texture->info.width, texture->info.height,
                     sluiceGetFormatName(texture->info.format), region.mipLevel, region.x, region.y,
                     c, (double)out->color[c], (double)range.low[c], (double)range.high[c]);
}

static void fetch_and_check(struct fetch *fetch)
{
    struct prober *prober = &fetch->scene->prober;
    harness_run(fetch->scene->h, record_fetch, fetch);
    for (uint32_t i = 0; i < fetch->count; i++)
        check_fetched(&fetch->scene->textures[fetch->texture], &prober_inputs(prober)[i],
                      &prober_outputs(prober)[i]);
    fetch->count = 0;
}

/* Fetches the last texel of every level, and some others. */
static void fetch_some(struct scene *scene, uint32_t index, uint32_t per_level)
{
    const SluiceImageInfo *info = &scene->textures[index].info;
    struct fetch fetch = {scene, index, 0};
    for (uint32_t level = 0; level < info->mipLevelCount; level++) {
        uint32_t width = slc_mip_size(info->width, level);
        uint32_t height = slc_mip_size(info->height, level);
        for (uint32_t i = 0; i < per_level; i++) {
            uint32_t x = i ? (uint32_t)roll() % width : width - 1;
            uint32_t y = i ? (uint32_t)roll() % height : height - 1;
            prober_inputs(&scene->prober)[fetch.count++] =
                (struct ProbeInput){.uv = {(float)x, (float)y}, .lodBias = (float)level};
            if (fetch.count == PROBE_CAPACITY)
                fetch_and_check(&fetch);
        }
    }
    fetch_and_check(&fetch);
}

static bool is_sampled(struct harness *h, SluiceFormat format)
{
    SluiceVulkanFormatCapabilities caps = {.structSize = sizeof caps};
    CHECK_OK(
        sluiceGetVulkanFormatCapabilities(h->instance, h->physical_device, h->get, format, &caps));
    return caps.sampled;
}

/* ETC2 and ASTC have no decoder here. test_integers compares integers. */
static bool is_compared(struct harness *h, SluiceFormat format)
{
    bool is_decoded = format < SLUICE_FORMAT_ETC2_R8G8B8_UNORM_BLOCK ||
                      format > SLUICE_FORMAT_ASTC_8x8_SRGB_BLOCK;
    return is_decoded && !slc_format_is_integer(format) && is_sampled(h, format);
}

static SluiceImageSource *texel_source(uint32_t width, uint32_t height, SluiceFormat format)
{
    bool is_signed = strstr(sluiceGetFormatName(format), "SNORM") != NULL;
    return pattern_source(is_signed ? PATTERN_SIGNED_HASH : PATTERN_HASH, width, height, format);
}

static void add_format(struct scene *scene, SluiceFormat format, const uint32_t (*sizes)[2],
                       uint32_t size_count)
{
    for (uint32_t s = 0; s < size_count; s++)
        scene_add(scene, sluiceGetFormatTexelSize(format)
                             ? texel_source(sizes[s][0], sizes[s][1], format)
                             : block_source(sizes[s][0], sizes[s][1], format));
}

/* Checks textures of every format in some sizes, as many at once as fit into a scene. */
static void check_formats(struct harness *h, const uint32_t (*even)[2], const uint32_t (*odd)[2],
                          uint32_t size_count, uint32_t per_level)
{
    for (uint32_t first = 1; first < SLUICE_FORMAT_COUNT; first += SCENE_TEXTURES / size_count) {
        struct scene scene;
        scene_init(
            &scene, h,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .pDebug = &map_everything});
        uint32_t f = first, count = 0;
        for (; f < SLUICE_FORMAT_COUNT && count + size_count <= SCENE_TEXTURES; f++) {
            if (!is_compared(h, (SluiceFormat)f))
                continue;
            add_format(&scene, (SluiceFormat)f, f % 2 ? odd : even, size_count);
            count += size_count;
        }
        SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
        for (uint32_t i = 0; i < 12 && (i == 0 || stats.mappedTileCount < stats.tileCount); i++) {
            scene_settle(&scene, 4);
            sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
        }
        assert_int_equal(stats.mappedTileCount, stats.tileCount);
        for (uint32_t i = 0; i < count; i++)
            fetch_some(&scene, i, per_level);
        scene_finish(&scene);
    }
}

/* Whole tiles; edges that cut tiles and blocks; less than a block; tall. */
static void texels_of_every_format_are_as_in_the_source(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1},    {3, 2},     {64, 64},    {259, 131},
                                        {5, 1200}, {600, 300}, {1024, 512}, {1031, 517}};
    roll_seed(3);
    check_formats(*state, sizes, sizes, sizeof sizes / sizeof sizes[0], 100);
}

/* A driver's mip tail may be the whole of such an image. */
static void texels_of_every_elongated_format_are_as_in_the_source(void **state)
{
    static const uint32_t wide[][2] = {{16384, 128}, {16380, 5}, {1, 16384}};
    static const uint32_t tall[][2] = {{128, 16384}, {5, 16380}, {16384, 1}};
    roll_seed(4);
    check_formats(*state, tall, wide, 3, 60);
}

/* lavapipe has neither ETC2 nor ASTC. */
static void formats_that_the_device_lacks_are_refused(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    uint32_t count = 0;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        if (slc_format_is_integer((SluiceFormat)f) || is_sampled(h, (SluiceFormat)f))
            continue;
        SluiceVulkanTexture texture;
        SluiceImageSource *source = block_source(64, 64, (SluiceFormat)f);
        SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = source};
        h->quiet = true;
        CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture),
                     SLUICE_ERROR_UNSUPPORTED);
        h->quiet = false;
        sluiceDestroyImageSource(source);
        count++;
    }
    print_message("# %u formats refused\n", count);
    scene_finish(&scene);
}

/* Feedback works for tiles that are not square and cut at the edge, not only if all is mapped. */
static void compressed_textures_are_streamed_by_feedback(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 100});
    roll_seed(4);
    const SluiceFormat formats[] = {SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK,
                                    SLUICE_FORMAT_BC3_UNORM_BLOCK, SLUICE_FORMAT_BC5_UNORM_BLOCK};
    const struct scene_aim corner = {0.1, 0.2, 0.2, 0.1, 0, 3, 0, 0};
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t t = scene_add(&scene, block_source(2050, 2000 + i, formats[i]));
        scene_aim(&scene, t, 64, &corner);
    }
    scene_settle(&scene, 14);
    assert_int_equal(scene_missing(&scene), 0);
    assert_int_equal(scene_non_resident(&scene), 0);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_true(stats.mappedTileCount < stats.tileCount / 2);
    scene_finish(&scene);
}

struct short_chain {
    uint32_t width, height;
    SluiceFormat format;
    uint32_t level_count;
};

static void cut_init(struct cut_source *cut, const struct short_chain *chain)
{
    cut_source_init(cut,
                    sluiceGetFormatTexelSize(chain->format)
                        ? pattern_source(PATTERN_LEVEL, chain->width, chain->height, chain->format)
                        : block_source(chain->width, chain->height, chain->format),
                    chain->level_count);
}

/* Also requests levels beyond the last. */
static void chains_may_end_with_any_level_that_fits_into_a_tile(void **state)
{
    static const struct short_chain chains[] = {
        {64, 64, SLUICE_FORMAT_R8G8B8A8_UNORM, 1},
        {128, 128, SLUICE_FORMAT_R8G8B8A8_UNORM, 1},
        {1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM, 4},
        {1000, 700, SLUICE_FORMAT_R8G8B8A8_UNORM, 5},
        {500, 250, SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, 1},
        {2050, 1100, SLUICE_FORMAT_BC3_UNORM_BLOCK, 5},
        {1024, 1024, SLUICE_FORMAT_BC5_UNORM_BLOCK, 9},
    };
    enum { COUNT = sizeof chains / sizeof chains[0] };
    const struct scene_aim all = {0, 0, 1, 1, 0, 12, 0, 0};
    static struct cut_source cuts[COUNT];
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    roll_seed(6);
    for (uint32_t i = 0; i < COUNT; i++) {
        cut_init(&cuts[i], &chains[i]);
        scene_aim(&scene, scene_add(&scene, &cuts[i].base), 64, &all);
    }
    scene_settle(&scene, 24);
    assert_int_equal(scene_missing(&scene), 0);
    assert_int_equal(scene_non_resident(&scene), 0);
    for (uint32_t i = 0; i < COUNT; i++) {
        const struct ProbeOutput *out = scene_outputs(&scene, i);
        for (uint32_t s = 0; s < 64 && chains[i].format == SLUICE_FORMAT_R8G8B8A8_UNORM; s++)
            assert_true(out[s].color[0] > 0.06f && out[s].color[3] > 0.99f &&
                        pattern_level(out[s].color) <
                            (float)chains[i].level_count - 1 + PATTERN_LEVEL_ERROR);
    }
    scene_finish(&scene);
}

static void chains_that_end_before_are_refused(void **state)
{
    static const struct short_chain chains[] = {
        {256, 256, SLUICE_FORMAT_R8G8B8A8_UNORM, 1},
        {1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM, 3},
        {4096, 64, SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, 3},
    };
    struct harness *h = *state;
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    for (size_t i = 0; i < sizeof chains / sizeof chains[0]; i++) {
        SluiceVulkanTexture texture;
        struct cut_source cut;
        cut_init(&cut, &chains[i]);
        SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = &cut.base};
        h->quiet = true;
        CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        h->quiet = false;
        sluiceDestroyImageSource(&cut.base);
    }
    scene_finish(&scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_of_every_format_are_as_in_the_source),
        cmocka_unit_test(texels_of_every_elongated_format_are_as_in_the_source),
        cmocka_unit_test(formats_that_the_device_lacks_are_refused),
        cmocka_unit_test(chains_may_end_with_any_level_that_fits_into_a_tile),
        cmocka_unit_test(chains_that_end_before_are_refused),
        cmocka_unit_test(compressed_textures_are_streamed_by_feedback),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
