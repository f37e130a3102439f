/*
 * Texels that invocations share: pictures of a texture of noise, magnified and not, against the
 * exact filter in double. Prints decodes per pixel and PSNR of single frames.
 */
#include "device/conform.h"

#include "support/test.h"
#include "vulkan/shader_twins.h"

#include "share_alone_comp.h"
#include "share_comp.h"
#include "share_shared.h"

#include <math.h>
#include <string.h>

enum { PIXELS = SHARE_PICTURE * SHARE_PICTURE, FRAMES = 16 };
enum { POINT, LINEAR, CUBIC };
enum { REPEAT, MIRROR, CLAMP, BORDER };

struct rig {
    struct harness *h;
    struct harness_buffer outputs;
    struct conform_set set;
    VkPipeline pipelines[2]; ///< with and without subgroups
    uint32_t subgroup_size;
};

/* Returns false if the device lacks the operations, so that samples share nothing. */
static bool shares(struct harness *h, uint32_t *size)
{
    VkPhysicalDeviceSubgroupProperties subgroup = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
    PFN_vkGetPhysicalDeviceProperties2 get =
        (PFN_vkGetPhysicalDeviceProperties2)h->get(h->instance, "vkGetPhysicalDeviceProperties2");
    const VkSubgroupFeatureFlags needed =
        VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
        VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT |
        VK_SUBGROUP_FEATURE_SHUFFLE_BIT | VK_SUBGROUP_FEATURE_QUAD_BIT;
    get(h->physical_device, &properties);
    *size = subgroup.subgroupSize;
    return (subgroup.supportedOperations & needed) == needed &&
           (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT);
}

static void rig_init(struct rig *rig, struct harness *h)
{
    rig->h = h;
    if (!shares(h, &rig->subgroup_size))
        SKIP_TEST("the device lacks subgroup operations");
    harness_buffer_init(h, &rig->outputs, PIXELS * sizeof(struct ShareOutput),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    conform_create_set(h, 1, 0, sizeof(struct ShareParams), &rig->set);
    conform_write_buffers(h, &rig->set, 1, (const struct harness_buffer *const[]){&rig->outputs});
    rig->pipelines[0] = conform_compute_pipeline(
        h, rig->set.layout, conform_module(h, share_comp, sizeof share_comp), NULL);
    rig->pipelines[1] = conform_compute_pipeline(
        h, rig->set.layout, conform_module(h, share_alone_comp, sizeof share_alone_comp), NULL);
}

static void rig_finish(struct rig *rig)
{
    for (uint32_t i = 0; i < 2; i++)
        rig->h->DestroyPipeline(rig->h->device, rig->pipelines[i], NULL);
    conform_destroy_set(rig->h, &rig->set);
    harness_buffer_finish(rig->h, &rig->outputs);
}

static const struct ShareOutput *render(struct rig *rig, const struct ShareParams *params,
                                        bool alone)
{
    conform_run_job(rig->h, &(struct conform_job){.set = &rig->set,
                                                  .stage = CONFORM_STAGE_COMPUTE,
                                                  .pipeline = rig->pipelines[alone],
                                                  .count = PIXELS,
                                                  .push = params,
                                                  .push_size = sizeof *params});
    return rig->outputs.mapped;
}

static double weigh(uint32_t kernel, double middle)
{
    double x = fabs(middle);
    if (kernel == LINEAR)
        return fmax(1 - x, 0);
    if (kernel == CUBIC)
        return x < 1 ? 2.0 / 3 - x * x + x * x * x / 2 : x < 2 ? pow(2 - x, 3) / 6 : 0;
    return middle > -0.5 && middle <= 0.5;
}

/* Texel of an axis; n: the border. */
static int64_t wrap(int64_t i, int64_t n, uint32_t mode)
{
    int64_t m = (i % (2 * n) + 2 * n) % (2 * n);
    if (mode == REPEAT)
        return m % n;
    if (mode == MIRROR)
        return m < n ? m : 2 * n - 1 - m;
    return mode == BORDER && (i < 0 || i >= n) ? n : i < 0 ? 0 : i >= n ? n - 1 : i;
}

static void filter_exactly(const struct ShareParams *p, uint32_t pixel, double rgba[4])
{
    uint32_t x = pixel % SHARE_PICTURE, y = pixel / SHARE_PICTURE;
    uint32_t key = p->flags & SHARE_FLAG_MIXED ? x & 1 : 0;
    float u = p->left + ((float)x + 0.5f) * p->step, v = p->top + ((float)y + 0.5f) * p->step;
    memset(rgba, 0, 4 * sizeof *rgba);
    for (uint32_t level = 0; level < p->levelCount; level++) {
        int64_t n = SHARE_TEXTURE >> level;
        double share = fmax(1 - fabs(fmin(fmax((double)p->lod, 0), p->levelCount - 1) - level), 0);
        double s = (double)u * (double)n, t = (double)v * (double)n;
        for (int64_t k = 0; k < 36; k++) {
            int64_t i = (int64_t)floor(s) - 2 + k % 6, j = (int64_t)floor(t) - 2 + k / 6;
            double w = share * weigh(p->kernel, (double)i + 0.5 - s) *
                       weigh(p->kernel, (double)j + 0.5 - t);
            i = wrap(i, n, p->modeU);
            j = wrap(j, n, p->modeV);
            if (w == 0 || i == n || j == n)
                continue;
            uint32_t h = slc_twin_hash((uint32_t)i, (uint32_t)j, level * 2 + key);
            for (uint32_t c = 0; c < 4; c++)
                rgba[c] += w * (h >> 8 * c & 255) / 255.0;
        }
    }
}

struct result {
    double decodes; ///< per pixel
    double exact;   ///< share of pixels
    double squares; ///< mean of a frame
    double bias;    ///< mean of squares of the mean of all frames
};

static struct result measure(struct rig *rig, struct ShareParams params, bool alone)
{
    static double sums[PIXELS][4], expected[PIXELS][4];
    struct result r = {0};
    memset(sums, 0, sizeof sums);
    for (uint32_t i = 0; i < PIXELS; i++)
        filter_exactly(&params, i, expected[i]);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        params.frame = frame;
        const struct ShareOutput *out = render(rig, &params, alone);
        for (uint32_t i = 0; i < PIXELS; i++) {
            r.decodes += out[i].decoded;
            r.exact += out[i].exact;
            for (uint32_t c = 0; c < 4; c++) {
                double error = (double)out[i].color[c] - expected[i][c];
                sums[i][c] += error / FRAMES;
                r.squares += error * error / 4;
                if (out[i].exact && params.levelCount == 1 && !(fabs(error) < 2e-5))
                    fail_msg("pixel %u, channel %u: %g off, but exact", i, c, error);
            }
        }
    }
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t c = 0; c < 4; c++)
            r.bias += sums[i][c] * sums[i][c] / 4 / PIXELS;
    r.decodes /= PIXELS * FRAMES;
    r.exact /= PIXELS * FRAMES;
    r.squares /= PIXELS * FRAMES;
    return r;
}

static double decibels(double squares)
{
    return squares > 1e-12 ? -10 * log10(squares) : 120;
}

static void sharing_decodes_less_and_is_less_noisy(void **state)
{
    static const char *const names[] = {"point", "linear", "cubic"};
    struct rig rig;
    rig_init(&rig, *state);
    for (uint32_t kernel = LINEAR; kernel <= CUBIC; kernel++)
        for (uint32_t zoom = 1; zoom <= 16; zoom *= 2) {
            struct ShareParams params = {.left = 0.137f,
                                         .top = -0.21f,
                                         .step = 1.0f / ((float)zoom * SHARE_TEXTURE),
                                         .lod = -log2f((float)zoom),
                                         .kernel = kernel,
                                         .levelCount = 1};
            struct result alone = measure(&rig, params, true),
                          shared = measure(&rig, params, false);
            print_message(
                "# subgroups of %u, %s, magnified %2u: %.3f decodes per pixel, %.3f exact, "
                "%.2f dB; alone %.2f dB\n",
                rig.subgroup_size, names[kernel], zoom, shared.decodes, shared.exact,
                decibels(shared.squares), decibels(alone.squares));
            assert_true(alone.decodes == 1 && alone.exact == 0);
            assert_true(shared.decodes <= 1 && shared.squares <= alone.squares);
            assert_true(zoom < 4 || shared.squares < alone.squares / 2);
            /* means of frames have the squares of independent errors alone */
            assert_true(alone.bias < 1.2 * alone.squares / FRAMES);
            assert_true(shared.bias < 1.2 * shared.squares / FRAMES + 1e-9);
        }
    rig_finish(&rig);
}

static void seams_levels_and_other_textures_are_not_mixed_up(void **state)
{
    struct rig rig;
    rig_init(&rig, *state);
    for (uint32_t i = 0; i < 16; i++) {
        struct ShareParams params = {.left = i & 1 ? -0.1f : 0.9f,
                                     .top = i & 1 ? 0.9f : -0.1f,
                                     .step = (i & 2 ? 0.1f : 0.5f) / SHARE_TEXTURE,
                                     .lod = i & 4   ? 0.4f
                                            : i & 2 ? -3.3f
                                                    : -1,
                                     .modeU = i % 4,
                                     .modeV = i / 4,
                                     .kernel = i % 3,
                                     .levelCount = i & 4 ? 3 : 1,
                                     .flags = i & 8 ? SHARE_FLAG_MIXED : 0};
        struct result r = measure(&rig, params, false);
        if (!(r.bias < 1.25 * r.squares / FRAMES + 1e-9))
            fail_msg("picture %u: bias %g, squares %g, exact %g", i, r.bias, r.squares, r.exact);
    }
    rig_finish(&rig);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(sharing_decodes_less_and_is_less_noisy),
        cmocka_unit_test(seams_levels_and_other_textures_are_not_mixed_up),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
