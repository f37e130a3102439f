/*
 * Cells of UDIM sets in a streamer: what their parts add up to, compared with an oracle that lays
 * the cells out as one large image. The cells are layers of an array.
 */
#include "device/array_scene.h"
#include "device/conform.h"

#include "support/roll.h"
#include "support/test.h"

#include "udim_comp.h"
#include "udim_hlsl.h"
#include "udim_min_lod_comp.h"
#include "udim_unpaged_comp.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 2048, SIZE = 512, LEVELS = 10, NO_EMPTY_CELL = 0xFF };

/* Devices find the level of a sample within 0.045, and lavapipe weighs in steps of 1/256. */
#define TOLERANCE 0.06

struct udim {
    struct array_scene a;
    struct probe_texture set;
    VkPipeline pipeline, own; ///< `own` is the prober's
    uint32_t empty;           ///< cell without a texture
};

static VkShaderModule create_module(const struct prober *p)
{
    if (p->h->min_lod)
        return conform_module(p->h, udim_min_lod_comp, sizeof udim_min_lod_comp);
    return p->paged ? conform_module(p->h, udim_comp, sizeof udim_comp)
                    : conform_module(p->h, udim_unpaged_comp, sizeof udim_unpaged_comp);
}

static void udim_init(struct udim *u, struct harness *h)
{
    *u = (struct udim){.empty = NO_EMPTY_CELL};
    scene_init(
        &u->a.scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .tilesPerFrame = 64});
    for (uint32_t i = 0; i < ARRAY_LAYERS; i++)
        u->a.layers[i] =
            pattern_source(array_scene_kind(i), SIZE, SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
    CHECK_OK(sluiceCreateArrayImageSource(u->a.layers, ARRAY_LAYERS, NULL, &u->a.source));
    const VkSamplerAddressMode clamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                            .source = u->a.source,
                                            .addressModeU = clamp,
                                            .addressModeV = clamp};
    SluiceVulkanTexture textures[ARRAY_LAYERS];
    CHECK_OK(sluiceAddVulkanTextureArray(u->a.scene.streamer, &create, ARRAY_LAYERS, textures));
    struct prober *prober = &u->a.scene.prober;
    u->set = prober_layer(prober, &textures[0], clamp, clamp, 1);
    struct prober_specialization specialization;
    u->pipeline = conform_compute_pipeline(h, prober->layout, create_module(prober),
                                           prober_specialize(prober, &specialization));
    u->own = prober->pipeline;
}

static void udim_finish(struct udim *u)
{
    struct harness *h = u->a.scene.h;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    h->DestroyPipeline(h->device, u->pipeline, NULL);
    array_scene_finish(&u->a);
}

static void record(void *user, VkCommandBuffer commands)
{
    struct udim *u = user;
    u->a.scene.prober.pipeline = u->pipeline;
    prober_record(&u->a.scene.prober, commands, u->set, 0, SAMPLES, ARRAY_LAYERS | u->empty << 8);
    u->a.scene.prober.pipeline = u->own;
}

/* Streams until every sample is as sharp as it should be. */
static void load(struct udim *u)
{
    struct harness *h = u->a.scene.h;
    const struct ProbeOutput *outputs = prober_outputs(&u->a.scene.prober);
    uint32_t missing = 1;
    for (uint32_t frame = 0; frame < 30 && missing; frame++) {
        harness_settle(h, u->a.scene.streamer, 1, record, u);
        assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
        missing = 0;
        for (uint32_t i = 0; i < SAMPLES; i++)
            missing += outputs[i].missingLevels != 0;
    }
    assert_int_equal(missing, 0);
}

/* Texels of all cells, level after level, RGBA8. */
static uint8_t texels[ARRAY_LAYERS][LEVELS][SIZE * SIZE * 4];

static void read_texels(struct udim *u)
{
    for (uint32_t layer = 0; layer < ARRAY_LAYERS; layer++)
        for (uint32_t level = 0; level < LEVELS; level++) {
            uint32_t n = SIZE >> level;
            const SluiceImageRegion all = {level, 0, 0, n, n};
            CHECK_OK(sluiceReadImageRegion(u->a.layers[layer], &all, texels[layer][level],
                                           (size_t)n * 4));
        }
}

/* Texels beyond the set and in its empty cell do not count. */
static void expect(const struct udim *u, uint32_t level, double x, double y, double color[4])
{
    int64_t n = SIZE >> level;
    double total = 0;
    x = x * (double)n - 0.5;
    y = y * (double)n - 0.5;
    memset(color, 0, 4 * sizeof *color);
    for (int64_t i = 0; i < 4; i++) {
        int64_t tx = (int64_t)floor(x) + i % 2, ty = (int64_t)floor(y) + i / 2;
        double weight = (i % 2 ? x - floor(x) : 1 - (x - floor(x))) *
                        (i / 2 ? y - floor(y) : 1 - (y - floor(y)));
        if (tx < 0 || ty < 0 || tx >= n * ARRAY_LAYERS || ty >= n || tx / n == u->empty)
            continue;
        const uint8_t *texel = texels[tx / n][level] + 4 * (ty * n + tx % n);
        for (uint32_t c = 0; c < 4; c++)
            color[c] += weight * texel[c] / 255;
        total += weight;
    }
    for (uint32_t c = 0; c < 4; c++)
        color[c] /= total;
}

static double roll_unit(void)
{
    return (double)roll() / ROLL_MAX;
}

/* Near edges of cells, at whole levels. Returns the level. */
static uint32_t draw_sample(struct ProbeInput *in, uint32_t i)
{
    uint32_t level = i % LEVELS;
    double texel = 1.0 / (SIZE >> level), edge = roll() % (ARRAY_LAYERS + 1);
    double offset = (roll_unit() - 0.5) * 3 * texel;
    double u = fmin(fmax(edge + offset, 1e-4), ARRAY_LAYERS - 1e-4);
    double v = fmin(fmax(roll_unit(), 1e-4), 1 - 1e-4);
    *in = (struct ProbeInput){.uv = {(float)u, (float)v},
                              .dx = {(float)texel},
                              .dy = {0, (float)texel},
                              .maxAnisotropy = 1};
    if (level == LEVELS - 1) /* and coarser than the last */
        in->dx[0] = in->dy[1] = (float)(texel * (1 + 3 * roll_unit()));
    return level;
}

static void check_sample(const struct udim *u, const struct ProbeInput *in, uint32_t i,
                         uint32_t level)
{
    const struct ProbeOutput *out = &prober_outputs(&u->a.scene.prober)[i];
    double color[4];
    if ((uint32_t)in->uv[0] == u->empty)
        return;
    expect(u, level, (double)in->uv[0], (double)in->uv[1], color);
    for (uint32_t c = 0; c < 4; c++)
        if (!(fabs((double)out->color[c] - color[c]) <= TOLERANCE))
            fail_msg("sample %u at (%.9g, %.9g), level %u, channel %u: %g instead of %g", i,
                     (double)in->uv[0], (double)in->uv[1], level, c, (double)out->color[c],
                     color[c]);
}

/* Arrays and sets in HLSL have the bits of GLSL. Its compiler has no clamp of the LOD. */
static void check_hlsl(struct udim *u)
{
    static struct ProbeOutput glsl[SAMPLES];
    struct harness *h = u->a.scene.h;
    struct prober *prober = &u->a.scene.prober;
    struct prober_specialization specialization;
    VkPipeline before = u->pipeline;
    if (h->min_lod)
        return;
    memcpy(glsl, prober_outputs(prober), sizeof glsl);
    scene_clear_outputs(&u->a.scene);
    u->pipeline =
        conform_compute_pipeline(h, prober->layout, conform_module(h, udim_hlsl, sizeof udim_hlsl),
                                 prober_specialize(prober, &specialization));
    harness_settle(h, u->a.scene.streamer, 1, record, u);
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    assert_memory_equal(prober_outputs(prober), glsl, sizeof glsl);
    h->DestroyPipeline(h->device, u->pipeline, NULL);
    u->pipeline = before;
}

static void check_large_image(struct harness *h, uint32_t empty)
{
    struct udim u;
    uint32_t levels[SAMPLES];
    udim_init(&u, h);
    u.empty = empty;
    read_texels(&u);
    struct ProbeInput *inputs = prober_inputs(&u.a.scene.prober);
    for (uint32_t i = 0; i < SAMPLES; i++)
        levels[i] = draw_sample(&inputs[i], i);
    load(&u);
    for (uint32_t i = 0; i < SAMPLES; i++)
        check_sample(&u, &inputs[i], i, levels[i]);
    check_hlsl(&u);
    udim_finish(&u);
}

static void whole_levels_are_those_of_one_large_image(void **state)
{
    check_large_image(*state, NO_EMPTY_CELL);
}

static void edges_to_empty_cells_are_clamped(void **state)
{
    check_large_image(*state, 1);
}

/* Between levels, too; with anisotropy where the device has it. */
static void colors_meet_at_edges(void **state)
{
    struct harness *h = *state;
    struct udim u;
    udim_init(&u, h);
    struct ProbeInput *inputs = prober_inputs(&u.a.scene.prober);
    const struct ProbeOutput *outputs = prober_outputs(&u.a.scene.prober);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        inputs[i] = inputs[i & ~1u];
        if (i % 2 == 0) {
            double width = exp2(roll_unit() * 10 - 9);
            inputs[i] = (struct ProbeInput){.uv = {0, (float)roll_unit()},
                                            .dx = {(float)width},
                                            .dy = {0, (float)width},
                                            .maxAnisotropy = 1};
        }
        inputs[i].uv[0] = (float)(1 + i / 2 % 2) + (i % 2 ? 2e-7f : -2e-7f);
    }
    load(&u);
    for (uint32_t i = 0; i < SAMPLES; i += 2) {
        assert_int_equal(outputs[i].wantedLevel, outputs[i + 1].wantedLevel); /* parts */
        assert_in_range(outputs[i].wantedLevel, 2, 4);
        for (uint32_t c = 0; c < 4; c++)
            assert_true(fabsf(outputs[i].color[c] - outputs[i + 1].color[c]) < 0.005f);
    }
    udim_finish(&u);
}

static void samples_outside_have_no_parts(void **state)
{
    struct harness *h = *state;
    struct udim u;
    udim_init(&u, h);
    struct ProbeInput *inputs = prober_inputs(&u.a.scene.prober);
    const struct ProbeOutput *outputs = prober_outputs(&u.a.scene.prober);
    static const float at[][2] = {{-0.001f, 0.5f}, {3, 0.5f},     {0.5f, -0.001f}, {0.5f, 1},
                                  {1e30f, 0.5f},   {0.5f, 1e30f}, {NAN, 0.5f},     {0, 0}};
    memset(inputs, 0, SAMPLES * sizeof *inputs);
    for (uint32_t i = 0; i < SAMPLES; i++)
        inputs[i] = (struct ProbeInput){
            .uv = {at[i % 8][0], at[i % 8][1]}, .dx = {0.1f}, .dy = {0, 0.1f}, .maxAnisotropy = 1};
    load(&u);
    for (uint32_t i = 0; i < 6; i++)
        assert_int_equal(outputs[i].wantedLevel, 0);
    assert_int_equal(outputs[6].wantedLevel, outputs[7].wantedLevel); /* NaN: as at (0, 0) */
    assert_true(outputs[7].wantedLevel > 0);
    udim_finish(&u);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_levels_are_those_of_one_large_image),
        cmocka_unit_test(edges_to_empty_cells_are_clamped),
        cmocka_unit_test(colors_meet_at_edges),
        cmocka_unit_test(samples_outside_have_no_parts),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
