/*
 * Streamed textures, sampled by one random texel. The color is that texel, and the loaded tiles are
 * those of the chosen texels. The test counts tiles from the texels alone.
 */
#include "device/conform.h"
#include "device/scene.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"

#include "stochastic_stream_comp.h"
#include "stochastic_stream_hlsl.h"
#include "stochastic_stream_shared.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 192, TILE = 128, MOST_TILES = 4096 };

struct rig {
    struct scene scene;
    struct probe_texture set;
    VkPipeline *pipeline;
    SluiceVulkanTexture texture;
    uint32_t width, height, mips, flags;
};

static double draw(double from, double to)
{
    return from + (to - from) * roll() / ROLL_MAX;
}

static void rig_init(struct rig *rig, struct harness *h, uint32_t width, uint32_t height,
                     VkSamplerAddressMode u, VkSamplerAddressMode v)
{
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .feedbackTimeoutTicks = 1000, .tilesPerFrame = 64};
    struct prober_specialization specialization;
    *rig = (struct rig){.width = width, .height = height};
    rig->mips = slc_mip_count(slc_max_u32(width, height));
    scene_init(&rig->scene, h, info);
    SluiceImageSource *source =
        pattern_source(PATTERN_HASH, width, height, SLUICE_FORMAT_R8G8B8A8_UNORM);
    uint32_t texture = scene_add_as(&rig->scene, source, u, v, 1, SLUICE_NO_TEXTURE);
    struct prober *p = &rig->scene.prober;
    rig->texture = rig->scene.textures[texture].texture;
    rig->set = rig->scene.textures[texture].probe;
    rig->pipeline = &h->probe_pipelines[HARNESS_PROBE_KINDS - 1]; /* the harness's */
    if (!*rig->pipeline)
        *rig->pipeline = conform_compute_pipeline(
            h, p->layout, conform_module(h, stochastic_stream_comp, sizeof stochastic_stream_comp),
            prober_specialize(p, &specialization));
}

static void record(void *user, VkCommandBuffer commands)
{
    struct rig *rig = user;
    VkPipeline own = rig->scene.prober.pipeline;
    rig->scene.prober.pipeline = *rig->pipeline;
    prober_record(&rig->scene.prober, commands, rig->set, 0, SAMPLES, rig->flags);
    rig->scene.prober.pipeline = own;
}

static void settle(struct rig *rig, uint32_t frame_count, uint32_t flags)
{
    rig->flags = flags;
    harness_settle(rig->scene.h, rig->scene.streamer, frame_count, record, rig);
    assert_int_equal(rig->scene.h->DeviceWaitIdle(rig->scene.h->device), VK_SUCCESS);
}

/* A corner of the texture and its edges, so that wrapping matters; few tiles. */
static void draw_samples(struct rig *rig, bool gaussian)
{
    for (uint32_t i = 0; i < SAMPLES; i++)
        prober_inputs(&rig->scene.prober)[i] =
            (struct ProbeInput){.uv = {(float)draw(-0.02, 0.2), (float)draw(-0.02, 0.2)},
                                .lodBias = (float)draw(-1, rig->mips),
                                .maxAnisotropy = gaussian ? (float)draw(0, 3) : 0};
}

static void check_colors(const struct rig *rig)
{
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const struct ProbeOutput *out = &prober_outputs(&rig->scene.prober)[i];
        float texel[4] = {0}; /* the border's */
        if (out->missingLevels == SLUICE_MIP_UNTOUCHED)
            continue;
        assert_true(out->level < rig->mips);
        if (!out->footprint[2])
            pattern_texel(PATTERN_HASH, out->level, out->footprint[0], out->footprint[1], texel);
        for (uint32_t c = 0; c < 4; c++)
            if (fabs((double)out->color[c] - (double)texel[c]) > 1e-3)
                fail_msg("sample %u, level %u, texel %u %u, channel %u: %g, not %g", i, out->level,
                         out->footprint[0], out->footprint[1], c, (double)out->color[c],
                         (double)texel[c]);
    }
}

/* Tiles of levels that have more than one that the wanted texels lie in, and those above them. */
static uint32_t count_tiles(const struct rig *rig)
{
    static uint32_t tiles[MOST_TILES][3];
    uint32_t count = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const struct ProbeOutput *out = &prober_outputs(&rig->scene.prober)[i];
        uint32_t x = out->footprint[0] / TILE, y = out->footprint[1] / TILE, k;
        for (uint32_t level = out->level; !out->footprint[2] && level < rig->mips; level++) {
            const uint32_t tile[3] = {level, x, y};
            uint32_t columns = slc_div_up_u32(slc_mip_size(rig->width, level), TILE);
            uint32_t rows = slc_div_up_u32(slc_mip_size(rig->height, level), TILE);
            for (k = 0; k < count && memcmp(tiles[k], tile, sizeof tile) != 0; k++)
                ;
            if (k == count && columns * rows > 1)
                memcpy(tiles[count++], tile, sizeof tile);
            assert_true(count < MOST_TILES);
            x = slc_min_u32(x / 2, slc_max_u32(columns / 2, 1) - 1);
            y = slc_min_u32(y / 2, slc_max_u32(rows / 2, 1) - 1);
        }
    }
    return count;
}

static void stream(struct harness *h, uint32_t width, uint32_t height, VkSamplerAddressMode u,
                   VkSamplerAddressMode v, uint32_t kernel)
{
    struct rig rig;
    uint32_t missing = 1;
    rig_init(&rig, h, width, height, u, v);
    draw_samples(&rig, kernel == 3);
    uint32_t flags = kernel | kernel << STOCHASTIC_SEED_SHIFT;
    for (uint32_t frame = 0; frame < 30 && missing; frame++) {
        settle(&rig, 1, flags | STOCHASTIC_MARK);
        check_colors(&rig);
        missing = 0;
        for (uint32_t i = 0; i < SAMPLES; i++)
            missing += prober_outputs(&rig.scene.prober)[i].missingLevels != 0;
    }
    assert_int_equal(missing, 0);
    settle(&rig, 4, flags | STOCHASTIC_MARK);
    check_colors(&rig);
    settle(&rig, 1, flags | STOCHASTIC_WANTED);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(rig.scene.streamer, &stats));
    uint32_t wanted = count_tiles(&rig), coarse = (uint32_t)stats.tileCount;
    for (uint32_t level = 0; level < rig.mips; level++) {
        uint32_t tiles = slc_div_up_u32(slc_mip_size(width, level), TILE) *
                         slc_div_up_u32(slc_mip_size(height, level), TILE);
        coarse -= tiles > 1 ? tiles : 0;
    }
    print_message("# %ux%u kernel %u: %u tiles wanted, %u mapped of %u\n", width, height, kernel,
                  wanted + coarse, (uint32_t)stats.mappedTileCount, (uint32_t)stats.tileCount);
    /* where sizes are odd, a tile may need more than one of the next coarser level */
    bool even = ((width | height) & (TILE - 1)) == 0;
    assert_in_range(stats.mappedTileCount, wanted + coarse, wanted + coarse + (even ? 0 : 2));
    scene_finish(&rig.scene);
}

static void chosen_texels_are_the_feedback(void **state)
{
    roll_seed(1);
    stream(*state, 2048, 2048, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT, 1);
    stream(*state, 2048, 1024, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
           VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 2);
}

/* Uses paged mode, in which all of the shader is used. */
static void hlsl_picks_and_marks_what_glsl_does(void **state)
{
    struct harness *h = *state;
    static struct ProbeOutput glsl[SAMPLES];
    struct prober_specialization specialization;
    struct rig rig;
    if (h->mode != SLUICE_RESIDENCY_MODE_PAGED)
        SKIP_TEST("compared in paged mode");
    roll_seed(3);
    rig_init(&rig, h, 1501, 1277, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
             VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT);
    VkPipeline hlsl = conform_compute_pipeline(
        h, rig.scene.prober.layout,
        conform_module(h, stochastic_stream_hlsl, sizeof stochastic_stream_hlsl),
        prober_specialize(&rig.scene.prober, &specialization));
    VkPipeline *pipelines[2] = {rig.pipeline, &hlsl};
    draw_samples(&rig, false);
    for (uint32_t kernel = 0; kernel < 4; kernel++) {
        for (uint32_t i = 0; i < 2; i++) {
            rig.pipeline = pipelines[i];
            settle(&rig, 1,
                   kernel | kernel << STOCHASTIC_SEED_SHIFT | (kernel ? 0 : STOCHASTIC_WANTED));
            if (i)
                assert_memory_equal(glsl, prober_outputs(&rig.scene.prober), sizeof glsl);
            memcpy(glsl, prober_outputs(&rig.scene.prober), sizeof glsl);
        }
        rig.pipeline = &hlsl; /* its marks bring tiles for the next one */
        settle(&rig, 6, kernel | STOCHASTIC_MARK);
        check_colors(&rig);
    }
    uint32_t there = 0;
    for (uint32_t i = 0; i < SAMPLES; i++)
        there += prober_outputs(&rig.scene.prober)[i].missingLevels == 0;
    assert_true(there > SAMPLES / 2);
    h->DestroyPipeline(h->device, hlsl, NULL);
    scene_finish(&rig.scene);
}

static void uneven_sizes_and_borders_too(void **state)
{
    roll_seed(2);
    stream(*state, 1501, 1277, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
           VK_SAMPLER_ADDRESS_MODE_REPEAT, 3);
    stream(*state, 1027, 1999, VK_SAMPLER_ADDRESS_MODE_REPEAT,
           VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, 0);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(chosen_texels_are_the_feedback),
        cmocka_unit_test(hlsl_picks_and_marks_what_glsl_does),
        cmocka_unit_test(uneven_sizes_and_borders_too),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
