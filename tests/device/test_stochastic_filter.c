/*
 * Texels drawn by stochastic_filter.glsl: compares their counts with probabilities in double.
 * Filters are integrated over texels, and folded by address modes as Vulkan defines them.
 */
#include "device/conform.h"

#include "support/roll.h"
#include "support/test.h"

#include "stochastic_comp.h"
#include "stochastic_shared.h"

#include <math.h>
#include <string.h>

enum { DRAWS = 16384, MAX_CALLS = 64, SIZE = 32 };
enum { POINT, LINEAR, CUBIC, GAUSSIAN };
enum { REPEAT, MIRROR, CLAMP, BORDER, MIRROR_ONCE, MODES };

struct rig {
    struct harness *h;
    struct harness_buffer calls, picks;
    struct conform_set set;
    VkPipeline pipeline;
};

static void rig_init(struct rig *rig, struct harness *h)
{
    rig->h = h;
    harness_buffer_init(h, &rig->calls, MAX_CALLS * sizeof(struct StochasticCall),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    harness_buffer_init(h, &rig->picks, MAX_CALLS * DRAWS * sizeof(struct StochasticPick),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    conform_create_set(h, 2, 0, 8, &rig->set);
    conform_write_buffers(h, &rig->set, 2,
                          (const struct harness_buffer *const[]){&rig->calls, &rig->picks});
    rig->pipeline = conform_compute_pipeline(
        h, rig->set.layout, conform_module(h, stochastic_comp, sizeof stochastic_comp), NULL);
}

static void rig_finish(struct rig *rig)
{
    rig->h->DestroyPipeline(rig->h->device, rig->pipeline, NULL);
    conform_destroy_set(rig->h, &rig->set);
    harness_buffer_finish(rig->h, &rig->calls);
    harness_buffer_finish(rig->h, &rig->picks);
}

static const struct StochasticPick *draw_all(struct rig *rig, const struct StochasticCall *calls,
                                             uint32_t count, uint32_t draws)
{
    uint32_t push[2] = {count * draws, draws};
    assert_in_range(count, 1, MAX_CALLS);
    memcpy(rig->calls.mapped, calls, count * sizeof *calls);
    conform_run_job(rig->h, &(struct conform_job){.set = &rig->set,
                                                  .stage = CONFORM_STAGE_COMPUTE,
                                                  .pipeline = rig->pipeline,
                                                  .count = count * draws,
                                                  .push = push,
                                                  .push_size = sizeof push});
    return rig->picks.mapped;
}

static double draw(double from, double to)
{
    return from + (to - from) * roll() / ROLL_MAX;
}

/* Returns the integral of the filter up to a texel's far edge, `t` texels from the coordinate. A
 * texel's probability is a difference of two. LINEAR and CUBIC are B-splines, which are box filters
 * of narrower ones: their integrals over a texel are values of the next wider spline. */
static double weigh(const struct StochasticCall *call, double middle)
{
    double x = fabs(middle), sigma = (double)call->sigma;
    if (call->kernel == LINEAR)
        return fmax(1 - x, 0);
    if (call->kernel == CUBIC)
        return x < 1 ? 2.0 / 3 - x * x + x * x * x / 2 : x < 2 ? pow(2 - x, 3) / 6 : 0;
    if (call->kernel == GAUSSIAN && sigma > 0)
        return 0.5 *
               (erf((middle + 0.5) / sigma / sqrt(2)) - erf((middle - 0.5) / sigma / sqrt(2)));
    return middle > -0.5 && middle <= 0.5;
}

/* Wraps a texel coordinate by Vulkan's tables of wrapping operations; n: border. */
static int64_t wrap(int64_t i, int64_t n, uint32_t mode)
{
    int64_t m = (i % (2 * n) + 2 * n) % (2 * n);
    if (mode == REPEAT)
        return m % n;
    if (mode == MIRROR)
        return m < n ? m : 2 * n - 1 - m;
    if (mode == BORDER)
        return i < 0 || i >= n ? n : i;
    if (mode == MIRROR_ONCE)
        i = i < 0 ? -1 - i : i;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/* Computes the probability of each texel, and of the border, along an axis of a level. */
static void find_axis(const struct StochasticCall *call, uint32_t axis, uint32_t level,
                      double probability[SIZE + 1])
{
    uint32_t size = axis ? call->height : call->width;
    int64_t n = size >> level ? size >> level : 1;
    double at = (double)call->uv[axis] * (double)n;
    int64_t reach = call->kernel == GAUSSIAN ? (int64_t)(8 * (double)call->sigma) + 2 : 3;
    memset(probability, 0, (SIZE + 1) * sizeof *probability);
    for (int64_t i = (int64_t)floor(at) - reach; i <= (int64_t)floor(at) + reach; i++)
        probability[wrap(i, n, axis ? call->modeV : call->modeU)] +=
            weigh(call, (double)i + 0.5 - at);
}

static double level_probability(const struct StochasticCall *call, uint32_t level)
{
    double lod = fmin(fmax((double)call->lod, 0), call->levelCount - 1);
    return fmax(1 - fabs(lod - level), 0);
}

static struct StochasticCall random_call(uint32_t i)
{
    uint32_t levels = 1 + (uint32_t)roll() % 4;
    struct StochasticCall call = {.width = 8 + (uint32_t)roll() % (SIZE - 7),
                                  .height = 8 + (uint32_t)roll() % (SIZE - 7),
                                  .levelCount = levels,
                                  .modeU = i % MODES,
                                  .modeV = i / 4 % MODES,
                                  .kernel = i % 4,
                                  .seed = 1 + i};
    call.lod = (float)draw(-1, levels);
    call.sigma = call.kernel == GAUSSIAN ? (float)draw(0.1, 2.5) : 0;
    for (uint32_t k = 0; k < 2; k++) /* a third near each edge */
        call.uv[k] = (float)(roll() % 3 ? roll() % 2 + draw(-0.1, 0.1) : draw(-1.5, 2.5));
    return call;
}

/* Computes the chi-square of one call's counts, and its degrees of freedom. Rare texels form one
 * class. */
static double chi_square(const struct StochasticCall *call, const struct StochasticPick *picks,
                         double *freedom)
{
    static uint32_t counts[4][SIZE + 1][SIZE + 1];
    double x[SIZE + 1], y[SIZE + 1], sum = 0, rare = 0, classes = 0;
    uint32_t rare_count = 0;
    memset(counts, 0, sizeof counts);
    for (uint32_t i = 0; i < DRAWS; i++) {
        uint32_t level = picks[i].level, w = call->width >> level, h = call->height >> level;
        assert_true(level < call->levelCount && picks[i].border <= 1);
        assert_true(picks[i].texel[0] >= 0 && picks[i].texel[0] < (int)w);
        assert_true(picks[i].texel[1] >= 0 && picks[i].texel[1] < (int)h);
        counts[level][picks[i].border ? SIZE : picks[i].texel[1]]
              [picks[i].border ? SIZE : picks[i].texel[0]]++;
    }
    for (uint32_t level = 0; level < call->levelCount; level++) {
        uint32_t w = call->width >> level, h = call->height >> level;
        double share = level_probability(call, level), inside = 0;
        find_axis(call, 0, level, x);
        find_axis(call, 1, level, y);
        for (uint32_t k = 0; k <= w * h; k++) {
            double p = k == w * h ? share - inside : share * x[k % w] * y[k / w];
            uint32_t n = k == w * h ? counts[level][SIZE][SIZE] : counts[level][k / w][k % w];
            inside += p;
            if (p * DRAWS < 10) {
                rare += fmax(p, 0) * DRAWS;
                rare_count += n;
                continue;
            }
            sum += pow(n - p * DRAWS, 2) / (p * DRAWS);
            classes++;
        }
    }
    if (rare < 1e-3 && rare_count > 1)
        fail_msg("%u draws of texels that have no weight", rare_count);
    if (rare >= 5) {
        sum += pow(rare_count - rare, 2) / rare;
        classes++;
    }
    *freedom = fmax(classes - 1, 0);
    return sum;
}

/* Returns the deviation of a chi-square from its mean, in standard deviations, by Wilson and
 * Hilferty. */
static double deviations(double sum, double freedom)
{
    double spread = 2 / (9 * freedom);
    return freedom > 0 ? (cbrt(sum / freedom) - 1 + spread) / sqrt(spread) : sum > 1 ? 99 : 0;
}

static void counts_of_texels_are_those_of_the_filter(void **state)
{
    struct rig rig;
    struct StochasticCall calls[MAX_CALLS];
    double worst = 0, total = 0, total_freedom = 0;
    roll_seed(1);
    rig_init(&rig, *state);
    for (uint32_t i = 0; i < MAX_CALLS; i++)
        calls[i] = random_call(i);
    const struct StochasticPick *picks = draw_all(&rig, calls, MAX_CALLS, DRAWS);
    for (uint32_t i = 0; i < MAX_CALLS; i++) {
        double freedom, sum = chi_square(&calls[i], &picks[(size_t)i * DRAWS], &freedom);
        total += sum;
        total_freedom += freedom;
        worst = fmax(worst, deviations(sum, freedom));
        if (deviations(sum, freedom) > 4)
            fail_msg("call %u: kernel %u, modes %u %u, sigma %g, uv %.9g %.9g, lod %g, %ux%u: "
                     "chi-square %g of %g",
                     i, calls[i].kernel, calls[i].modeU, calls[i].modeV, (double)calls[i].sigma,
                     (double)calls[i].uv[0], (double)calls[i].uv[1], (double)calls[i].lod,
                     calls[i].width, calls[i].height, sum, freedom);
    }
    print_message("# chi_square %.0f of %.0f degrees, worst call %.2f deviations\n", total,
                  total_freedom, worst);
    assert_true(fabs(deviations(total, total_freedom)) < 3);
    rig_finish(&rig);
}

/* Evenly spread numbers give counts that are off by less than one per end of a run, so no
 * randomness hides a bias. The other number is fixed, and so is its texel. */
static void even_numbers_give_even_counts(void **state)
{
    struct rig rig;
    struct StochasticCall calls[MAX_CALLS];
    roll_seed(2);
    rig_init(&rig, *state);
    for (uint32_t i = 0; i < MAX_CALLS; i++) {
        calls[i] = random_call(i);
        calls[i].kernel = i % 3;
        calls[i].levelCount = 1;
        calls[i].seed = 0;
        calls[i].grid = DRAWS;
        calls[i].axis = i / 3 % 2;
    }
    const struct StochasticPick *picks = draw_all(&rig, calls, MAX_CALLS, DRAWS);
    for (uint32_t i = 0; i < MAX_CALLS; i++) {
        double probability[SIZE + 1];
        uint32_t counts[SIZE + 1] = {0}, axis = calls[i].axis;
        uint32_t *mode = axis ? &calls[i].modeV : &calls[i].modeU;
        if (*mode == BORDER) /* at the border a pick uses the edge's texel */
            *mode = CLAMP;
        find_axis(&calls[i], axis, 0, probability);
        for (uint32_t k = 0; k < DRAWS; k++)
            counts[picks[(size_t)i * DRAWS + k].texel[axis]]++;
        for (uint32_t k = 0; k < (axis ? calls[i].height : calls[i].width); k++)
            if (!(fabs(counts[k] - probability[k] * DRAWS) <= 4))
                fail_msg("call %u, texel %u: %u draws, not %g", i, k, counts[k],
                         probability[k] * DRAWS);
    }
    rig_finish(&rig);
}

/* The remainders of both numbers are uniform, and independent of the choice. */
static void used_numbers_are_uniform_again(void **state)
{
    enum { CELLS = 8 };
    struct rig rig;
    struct StochasticCall calls[12];
    roll_seed(3);
    rig_init(&rig, *state);
    for (uint32_t i = 0; i < 12; i++) {
        calls[i] = random_call(i);
        calls[i].kernel = i % 3;
        calls[i].levelCount = 3;
        calls[i].lod = (float)draw(0, 2);
    }
    const struct StochasticPick *picks = draw_all(&rig, calls, 12, DRAWS);
    for (uint32_t i = 0; i < 12; i++) {
        uint32_t counts[CELLS * CELLS] = {0};
        double sum = 0, each = (double)DRAWS / (CELLS * CELLS);
        for (uint32_t k = 0; k < DRAWS; k++) {
            const float *random = picks[(size_t)i * DRAWS + k].random;
            assert_true(random[0] >= 0 && random[0] < 1 && random[1] >= 0 && random[1] < 1);
            counts[(int)(random[0] * CELLS) * CELLS + (int)(random[1] * CELLS)]++;
        }
        for (uint32_t k = 0; k < CELLS * CELLS; k++)
            sum += pow(counts[k] - each, 2) / each;
        if (fabs(deviations(sum, CELLS * CELLS - 1)) > 4)
            fail_msg("call %u: chi-square %g of %d", i, sum, CELLS * CELLS - 1);
    }
    rig_finish(&rig);
}

static void sigma_zero_is_the_nearest_texel(void **state)
{
    struct rig rig;
    struct StochasticCall calls[MAX_CALLS];
    roll_seed(4);
    rig_init(&rig, *state);
    for (uint32_t i = 0; i < MAX_CALLS; i += 2) {
        calls[i] = random_call(i);
        calls[i].kernel = GAUSSIAN;
        calls[i].sigma = 0;
        calls[i + 1] = calls[i];
        calls[i + 1].kernel = POINT;
    }
    const struct StochasticPick *picks = draw_all(&rig, calls, MAX_CALLS, 64);
    for (uint32_t i = 0; i < MAX_CALLS; i += 2)
        for (uint32_t k = 0; k < 64; k++)
            assert_memory_equal(&picks[i * 64 + k], &picks[i * 64 + 64 + k], 16);
    rig_finish(&rig);
}

/* Extreme arguments: every pick is inside its level. */
static void picks_lie_inside_whatever_the_arguments(void **state)
{
    static const float ends[] = {0,       -0.0f,  1,     -1,  0.5f,     1e-38f,
                                 8388609, -1e30f, 3e38f, NAN, INFINITY, -INFINITY};
    static const float randoms[] = {0, 1, 0.99999994f, 5.9604645e-8f, 0.5f};
    enum { ENDS = sizeof ends / sizeof ends[0], RANDOMS = sizeof randoms / sizeof randoms[0] };
    struct rig rig;
    struct StochasticCall calls[MAX_CALLS];
    roll_seed(5);
    rig_init(&rig, *state);
    for (uint32_t pass = 0; pass < 40; pass++) {
        for (uint32_t i = 0; i < MAX_CALLS; i++) {
            calls[i] = random_call(i);
            calls[i].seed = 0;
            if (pass % 4 == 3)
                calls[i].width = calls[i].height = 1;
            calls[i].levelCount = pass % 4 == 3 ? 1 : 3;
            calls[i].lod = ends[roll() % ENDS];
            calls[i].sigma = ends[roll() % ENDS];
            for (uint32_t k = 0; k < 2; k++) {
                calls[i].uv[k] = ends[roll() % ENDS];
                calls[i].random[k] = randoms[roll() % RANDOMS];
            }
        }
        const struct StochasticPick *picks = draw_all(&rig, calls, MAX_CALLS, 1);
        for (uint32_t i = 0; i < MAX_CALLS; i++) {
            assert_true(picks[i].level < calls[i].levelCount);
            assert_true(picks[i].texel[0] >= 0);
            assert_true(picks[i].texel[0] < (int)fmax(calls[i].width >> picks[i].level, 1));
            assert_true(picks[i].texel[1] >= 0);
            assert_true(picks[i].texel[1] < (int)fmax(calls[i].height >> picks[i].level, 1));
        }
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
        cmocka_unit_test(counts_of_texels_are_those_of_the_filter),
        cmocka_unit_test(even_numbers_give_even_counts),
        cmocka_unit_test(used_numbers_are_uniform_again),
        cmocka_unit_test(sigma_zero_is_the_nearest_texel),
        cmocka_unit_test(picks_lie_inside_whatever_the_arguments),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
