/*
 * Jittered samples: the distribution of their offsets, the filter that their mean is, and feedback
 * of all offsets. The oracle integrates the densities that jitter.glsl states, in double.
 */
#include "device/conform.h"
#include "device/demand_runner.h"
#include "device/scene.h"

#include "base/checked.h"
#include "support/map_everything.h"
#include "support/roll.h"
#include "support/test.h"

#include "jitter_comp.h"
#include "jitter_shared.h"

#include <math.h>

#define SAMPLES 96u
#define SIZE 512u
/* Bilinear weights have steps of 1/256. Nearest taps change within a step of the grid of random
 * numbers. Devices find the LOD of a sample within 0.045. */
#define TOLERANCE 0.02
#define TOLERANCE_NEAREST 0.05
#define TOLERANCE_BETWEEN_LEVELS 0.06

enum kernel { BOX, TENT, GAUSSIAN, KERNELS };
static const double reaches[KERNELS] = {0.5, 1, 1.25};

struct rig {
    struct scene scene;
    struct probe_texture set;
    VkPipeline *pipeline;
    uint32_t count, flags;
};

static double draw(double from, double to)
{
    return from + (to - from) * roll() / ROLL_MAX;
}

static void rig_init(struct rig *rig, struct harness *h, uint32_t size, bool everything)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .feedbackTimeoutTicks = 1000,
                                           .tilesPerFrame = 64,
                                           .pDebug = everything ? &map_everything : NULL};
    struct prober_specialization specialization;
    *rig = (struct rig){.count = SAMPLES};
    scene_init(&rig->scene, h, info);
    uint32_t texture = scene_add(
        &rig->scene, pattern_source(PATTERN_HASH, size, size, SLUICE_FORMAT_R8G8B8A8_UNORM));
    struct prober *p = &rig->scene.prober;
    rig->set = rig->scene.textures[texture].probe;
    rig->pipeline = &h->probe_pipelines[HARNESS_PROBE_KINDS - 1]; /* the harness's */
    if (!*rig->pipeline)
        *rig->pipeline = conform_compute_pipeline(
            h, p->layout, conform_module(h, jitter_comp, sizeof jitter_comp),
            prober_specialize(p, &specialization));
}

static void record(void *user, VkCommandBuffer commands)
{
    struct rig *rig = user;
    VkPipeline own = rig->scene.prober.pipeline;
    rig->scene.prober.pipeline = *rig->pipeline;
    prober_record(&rig->scene.prober, commands, rig->set, 0, rig->count, rig->flags);
    rig->scene.prober.pipeline = own;
}

static void settle(struct rig *rig, uint32_t frame_count, uint32_t flags)
{
    rig->flags = flags;
    harness_settle(rig->scene.h, rig->scene.streamer, frame_count, record, rig);
    assert_int_equal(rig->scene.h->DeviceWaitIdle(rig->scene.h->device), VK_SUCCESS);
}

/* Share of offsets below `t`. */
static double distribution(enum kernel kernel, double t)
{
    if (kernel == TENT)
        return t < 0 ? (1 + t) * (1 + t) / 2 : 1 - (1 - t) * (1 - t) / 2;
    if (kernel == GAUSSIAN)
        return 0.5 + 0.5 * erf(2 * t / sqrt(2)) / erf(2.5 / sqrt(2));
    return t + 0.5;
}

static double density(enum kernel kernel, double t)
{
    if (fabs(t) > reaches[kernel])
        return 0;
    if (kernel == TENT)
        return 1 - fabs(t);
    return kernel == GAUSSIAN ? exp(-2 * t * t) * 2 / sqrt(2 * acos(-1.0)) / erf(2.5 / sqrt(2)) : 1;
}

static void offsets_have_the_distribution_of_their_kernel(void **state)
{
    struct rig rig;
    rig_init(&rig, *state, SIZE, true);
    const struct ProbeOutput *outputs = prober_outputs(&rig.scene.prober);
    for (uint32_t kernel = 0; kernel < KERNELS; kernel++) {
        for (uint32_t i = 0; i < SAMPLES; i++) {
            double edge = i % 2 ? 0.5 : -0.5;
            prober_inputs(&rig.scene.prober)[i] = (struct ProbeInput){
                .uv = {(float)(i < 2 ? edge : draw(-0.5, 0.5)), i ? (float)draw(-0.5, 0.5) : 0}};
        }
        settle(&rig, 1, JITTER_OFFSETS | kernel);
        assert_true(outputs[0].color[1] == 0.0f); /* 0 is the center */
        for (uint32_t i = 0; i < SAMPLES; i++)
            for (uint32_t c = 0; c < 2; c++) {
                double offset = (double)outputs[i].color[c];
                double random = (double)prober_inputs(&rig.scene.prober)[i].uv[c];
                assert_true(fabs(offset) <= reaches[kernel] + 1e-4);
                if (!(fabs(distribution(kernel, offset) - 0.5 - random) <= 1e-5))
                    fail_msg("kernel %u: %.9g becomes %.9g, of distribution %.9g", kernel, random,
                             offset, distribution(kernel, offset) - 0.5);
            }
    }
    scene_finish(&rig.scene);
}

/* Weight of a texel that is `distance` texels of its level away, of a tap that is one texel wide or
 * linear. `scale`: texels of the level per unit of offset. */
static double weigh(enum kernel kernel, bool nearest, double scale, double distance)
{
    const uint32_t steps = 1000;
    double sum = 0, step = 2 * reaches[kernel] / steps;
    for (uint32_t i = 0; i < steps; i++) {
        double t = (i + 0.5) * step - reaches[kernel], away = fabs(distance - t * scale);
        sum += density(kernel, t) * step * (nearest ? away < 0.5 : fmax(1 - away, 0));
    }
    return sum;
}

/* Texels of an image that repeats. */
struct texels {
    uint32_t width, height;
    struct runner_image *image; ///< NULL: PATTERN_HASH
};

enum { AROUND = 8 }; /* texels to either side that a sample may weigh */

static void weigh_axis(double weights[2 * AROUND], double coordinate, uint32_t size,
                       enum kernel kernel, bool nearest, double scale)
{
    double at = coordinate * size, first = floor(at) - AROUND;
    for (uint32_t k = 0; k < 2 * AROUND; k++)
        weights[k] = weigh(kernel, nearest, scale, first + k + 0.5 - at);
}

static uint32_t wrap(double coordinate, uint32_t size, uint32_t k)
{
    int64_t n = size, at = (int64_t)floor(coordinate * size) - AROUND + k;
    return (uint32_t)((at % n + n) % n);
}

static void add_level(double rgba[4], const struct texels *texels, const float uv[2],
                      uint32_t level, double weight, enum kernel kernel, bool nearest, double scale)
{
    double weights[2][2 * AROUND], u = (double)uv[0], v = (double)uv[1];
    uint32_t width = slc_mip_size(texels->width, level);
    uint32_t height = slc_mip_size(texels->height, level);
    weigh_axis(weights[0], u, width, kernel, nearest, scale);
    weigh_axis(weights[1], v, height, kernel, nearest, scale);
    for (uint32_t k = 0; k < 4 * AROUND * AROUND; k++) {
        uint32_t column = k % (2 * AROUND), row = k / (2 * AROUND);
        double share = weight * weights[0][column] * weights[1][row];
        uint32_t x = wrap(u, width, column), y = wrap(v, height, row);
        float texel[4];
        if (share == 0)
            continue;
        if (texels->image)
            runner_image_texel(texels->image, level, x, y, texel);
        else
            pattern_texel(PATTERN_HASH, level, x, y, texel);
        for (uint32_t c = 0; c < 4; c++)
            rgba[c] += share * (double)texel[c];
    }
}

static void check_mean(const struct rig *rig, uint32_t i, double lod, enum kernel kernel,
                       bool nearest)
{
    const struct ProbeInput *in = &prober_inputs((struct prober *)&rig->scene.prober)[i];
    const struct ProbeOutput *out = &prober_outputs(&rig->scene.prober)[i];
    double shown = fmax(lod, 0), expected[4] = {0};
    uint32_t level = (uint32_t)shown;
    double fraction = shown - level, scale = exp2(fraction);
    const struct texels texels = {SIZE, SIZE, NULL};
    add_level(expected, &texels, in->uv, level, 1 - fraction, kernel, nearest, scale);
    if (fraction > 0)
        add_level(expected, &texels, in->uv, level + 1, fraction, kernel, nearest, scale / 2);
    double tolerance = fraction > 0 ? TOLERANCE_BETWEEN_LEVELS
                       : nearest    ? TOLERANCE_NEAREST
                                    : TOLERANCE;
    for (uint32_t c = 0; c < 4; c++)
        if (!(fabs((double)out->color[c] - expected[c]) <= tolerance))
            fail_msg("kernel %u, %s, sample %u at (%.9g, %.9g), lod %g, channel %u: %g, not %g",
                     kernel, nearest ? "nearest" : "linear", i, (double)in->uv[0],
                     (double)in->uv[1], lod, c, (double)out->color[c], expected[c]);
}

static void check_means(struct rig *rig, enum kernel kernel, bool nearest)
{
    double lods[SAMPLES];
    for (uint32_t i = 0; i < SAMPLES; i++) {
        lods[i] = (double)(i % 6) - 1;
        if (i % 12 == 11 && !nearest)
            lods[i] = draw(0, 4);
        double texels = exp2(lods[i]) / SIZE, bias = i % 3 == 2 ? 1 : 0;
        prober_inputs(&rig->scene.prober)[i] =
            (struct ProbeInput){.uv = {(float)draw(-1, 1), (float)draw(-1, 1)},
                                .dx = {(float)(texels * exp2(-bias)), 0},
                                .dy = {0, (float)(texels * exp2(-bias))},
                                .lodBias = (float)bias,
                                .maxAnisotropy = 1};
    }
    settle(rig, 1, JITTER_SAMPLE | kernel);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        assert_int_equal(prober_outputs(&rig->scene.prober)[i].missingLevels, 0);
        check_mean(rig, i, lods[i], kernel, nearest);
    }
}

static void means_are_the_filters_of_the_table(void **state)
{
    struct rig rig;
    roll_seed(1);
    rig_init(&rig, *state, SIZE, true);
    settle(&rig, 12, 0);
    for (uint32_t kernel = 0; kernel < KERNELS; kernel++)
        check_means(&rig, (enum kernel)kernel, false);
    rig.set = prober_nearest(&rig.scene.prober, &rig.scene.textures[0].texture);
    if (!rig.scene.prober.paged) /* its pages have a sampler of their own */
        for (uint32_t kernel = 0; kernel < KERNELS; kernel++)
            check_means(&rig, (enum kernel)kernel, true);
    scene_finish(&rig.scene);
}

/* Few samples, about as far from corners of tiles as offsets reach. */
static void feedback_covers_all_offsets(void **state)
{
    enum { LARGE = 4096, TILE = 128, FEW = 24 };
    for (uint32_t kernel = 0; kernel < KERNELS; kernel++) {
        struct rig rig;
        uint32_t missing = 1;
        roll_seed(2 + kernel);
        rig_init(&rig, *state, LARGE, false);
        rig.count = FEW;
        for (uint32_t i = 0; i < FEW; i++) {
            double lod = draw(0, 2), texel = exp2(lod) / LARGE, at[2];
            for (uint32_t axis = 0; axis < 2; axis++)
                at[axis] = (double)(TILE * (roll() % (LARGE / TILE))) / LARGE +
                           draw(-1, 1) * (reaches[kernel] + 1) * texel;
            prober_inputs(&rig.scene.prober)[i] =
                (struct ProbeInput){.uv = {(float)at[0], (float)at[1]},
                                    .dx = {(float)texel, 0},
                                    .dy = {0, (float)texel},
                                    .maxAnisotropy = 1};
        }
        for (uint32_t frame = 0; frame < 40 && missing; frame++) {
            settle(&rig, 6, JITTER_FEEDBACK | kernel);
            settle(&rig, 1, JITTER_FEEDBACK | JITTER_SAMPLE | kernel);
            missing = 0;
            for (uint32_t i = 0; i < FEW; i++)
                missing += prober_outputs(&rig.scene.prober)[i].missingLevels != 0;
        }
        assert_int_equal(missing, 0);
        scene_finish(&rig.scene);
    }
}

enum { PLACES = 24, DRAWS = JITTER_GRID * JITTER_GRID };

static void add_draws(struct runner *r, SluiceDemandTextureId id, uint32_t level, uint32_t kernel)
{
    struct RunnerInput in = {.kind = RUNNER_JITTER,
                             .index = (uint32_t)id,
                             .uv = {(float)draw(-1, 1), (float)draw(-1, 1)},
                             .dx = {(float)exp2(level) / SIZE},
                             .cell = kernel};
    for (uint32_t i = 0; i < DRAWS; i++) {
        in.dy[0] = ((float)(i % JITTER_GRID) + 0.5f) / JITTER_GRID - 0.5f;
        in.dy[1] = ((float)(i / JITTER_GRID) + 0.5f) / JITTER_GRID - 0.5f;
        runner_add(r, in);
    }
}

static void check_draws(const struct runner *r, struct runner_image *image, uint32_t place,
                        uint32_t level, enum kernel kernel, bool nearest)
{
    const struct RunnerInput *in =
        &((const struct RunnerInput *)r->inputs.mapped)[(size_t)place * DRAWS];
    const struct texels texels = {SIZE, SIZE, image};
    double mean[4] = {0}, expected[4] = {0};
    for (uint32_t i = 0; i < DRAWS; i++)
        for (uint32_t c = 0; c < 4; c++)
            mean[c] += (double)runner_output(r, place * DRAWS + i).color[c] / DRAWS;
    add_level(expected, &texels, in->uv, level, 1, kernel, nearest, 1);
    for (uint32_t c = 0; c < 4; c++)
        assert_float_equal(mean[c], expected[c], nearest ? TOLERANCE_NEAREST : TOLERANCE);
}

static void textures_on_demand_are_jittered_by_their_own_size_and_bias(void **state)
{
    static const SluiceDemandSampler linear = {.structSize = sizeof linear, .lodBias = 1};
    struct runner_image image;
    struct runner r;
    runner_init(&r, *state, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 80);
    SluiceDemandTextureId biased, nearest = runner_add_texture(&r, &image);
    const SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info, .image = runner_image_desc(&image), .pSampler = &linear};
    CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &biased));
    for (uint32_t i = 0; i < PLACES; i++)
        add_draws(&r, i % 2 ? biased : nearest, i % 3, i % KERNELS);
    assert_in_range(runner_load(&r, 30), 2, 29);
    for (uint32_t i = 0; i < PLACES; i++)
        check_draws(&r, &image, i, i % 2 ? i % 3 + 1 : i % 3, i % KERNELS, i % 2 == 0);
    runner_finish(&r);
    runner_image_finish(&image);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(offsets_have_the_distribution_of_their_kernel),
        cmocka_unit_test(means_are_the_filters_of_the_table),
        cmocka_unit_test(feedback_covers_all_offsets),
        cmocka_unit_test(textures_on_demand_are_jittered_by_their_own_size_and_bias),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
