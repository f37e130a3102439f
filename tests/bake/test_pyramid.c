/* Compares levels made row by row with sums over all texels in long double. */
#include "bake/pyramid.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_LEVELS 12

struct case_ {
    uint32_t width, height;
    SluiceBakeFilter filter;
    SluiceBakeWrap wrap_x, wrap_y;
};

/* Levels that were made, and the expected ones. */
struct levels {
    const struct case_ *what;
    uint32_t count;
    float *made[MAX_LEVELS];
    uint8_t *seen[MAX_LEVELS];
    long double *expected[MAX_LEVELS];
};

static uint32_t next_random(uint32_t *random)
{
    return *random = *random * 1664525u + 1013904223u;
}

static void levels_init(struct levels *levels, const struct case_ *what)
{
    *levels = (struct levels){.what = what};
    levels->count = slc_mip_count(slc_max_u32(what->width, what->height));
    assert_true(levels->count <= MAX_LEVELS);
    for (uint32_t l = 0; l < levels->count; l++) {
        size_t count = (size_t)slc_mip_size(what->width, l) * slc_mip_size(what->height, l);
        levels->made[l] = calloc(4 * count, sizeof(float));
        levels->seen[l] = calloc(count, 1);
        levels->expected[l] = calloc(4 * count, sizeof(long double));
    }
    uint32_t random = what->width * 31 + what->height;
    for (size_t i = 0; i < 4 * (size_t)what->width * what->height; i++) {
        levels->made[0][i] = (float)(next_random(&random) >> 8) * 0x1p-24f;
        levels->expected[0][i] = levels->made[0][i];
    }
}

static void levels_finish(struct levels *levels)
{
    for (uint32_t l = 0; l < levels->count; l++) {
        free(levels->made[l]);
        free(levels->seen[l]);
        free(levels->expected[l]);
    }
}

/* Share of texel `i` below that texel `s` above covers. */
static long double overlap(uint32_t size, uint32_t below, uint32_t i, long s)
{
    long double scale = (long double)size / below;
    long double low = fmaxl(i * scale, s), high = fminl((i + 1) * scale, s + 1.0L);
    return high > low ? (high - low) / scale : 0;
}

/* I0(x) as the mean of exp(x cos t) over half a turn. Few points suffice, since the function is
 * periodic. */
static long double bessel(long double x)
{
    long double sum = 0;
    for (int i = 0; i < 20; i++)
        sum += expl(x * cosl(acosl(-1) * (i + 0.5L) / 20));
    return sum / 20;
}

/* Kaiser filter of bake.h: a sinc 6 texels wide, windowed (alpha 4), integrated independently. */
static long double kaiser(uint32_t size, uint32_t below, uint32_t i, long s)
{
    long double scale = (long double)size / below, sum = 0, pi = acosl(-1), peak = bessel(4);
    for (int k = 0; k < 32; k++) {
        long double x = (s + (k + 0.5L) / 32) / scale - (i + 0.5L);
        if (fabsl(x) < 3)
            sum += (x == 0 ? 1 : sinl(pi * x) / (pi * x)) * bessel(4 * sqrtl(1 - x * x / 9)) / peak;
    }
    return sum;
}

/* Returns the texel beyond an edge, found by walking. */
static uint32_t wrapped(SluiceBakeWrap wrap, long s, uint32_t size)
{
    long at = 0, step = 1;
    if (wrap == SLUICE_BAKE_WRAP_CLAMP)
        return s < 0 ? 0 : s >= (long)size ? size - 1 : (uint32_t)s;
    if (wrap == SLUICE_BAKE_WRAP_REPEAT)
        return (uint32_t)((s + 100 * (long)size) % size);
    if (s < 0) /* the mirror image of -1 is 0 */
        s = -s - 1;
    for (long i = 0; i < s; i++) {
        if (at + step < 0 || at + step >= (long)size)
            step = -step;
        else
            at += step;
    }
    return (uint32_t)at;
}

/* Weights [below][size], with everything beyond the edges folded in. */
static long double *weights(uint32_t size, uint32_t below, SluiceBakeFilter filter,
                            SluiceBakeWrap wrap)
{
    long double *all = calloc((size_t)size * below, sizeof *all);
    for (uint32_t i = 0; i < below; i++) {
        long double sum = 0;
        for (long s = -12; s < (long)size + 12; s++) {
            long double weight = size == 1                          ? s == 0
                                 : filter == SLUICE_BAKE_FILTER_BOX ? overlap(size, below, i, s)
                                                                    : kaiser(size, below, i, s);
            all[i * size + wrapped(wrap, s, size)] += weight;
            sum += weight;
        }
        for (uint32_t s = 0; s < size; s++)
            all[i * size + s] /= sum;
    }
    return all;
}

static void expect_level(struct levels *levels, uint32_t l)
{
    const struct case_ *what = levels->what;
    uint32_t width = slc_mip_size(what->width, l - 1), height = slc_mip_size(what->height, l - 1);
    uint32_t below_width = slc_mip_size(width, 1), below_height = slc_mip_size(height, 1);
    long double *in_x = weights(width, below_width, what->filter, what->wrap_x);
    long double *in_y = weights(height, below_height, what->filter, what->wrap_y);
    for (uint32_t y = 0; y < below_height; y++)
        for (uint32_t x = 0; x < below_width; x++)
            for (uint32_t v = 0; v < height; v++)
                for (uint32_t u = 0; u < width && in_y[y * height + v] != 0; u++)
                    for (uint32_t c = 0; c < 4; c++)
                        levels->expected[l][4 * (y * below_width + x) + c] +=
                            in_y[y * height + v] * in_x[x * width + u] *
                            levels->expected[l - 1][4 * (v * width + u) + c];
    free(in_x);
    free(in_y);
}

static SluiceResult on_row(void *user, uint32_t level, uint32_t y, const float *rgba)
{
    struct levels *levels = user;
    uint32_t width = slc_mip_size(levels->what->width, level);
    assert_true(level < levels->count && y < slc_mip_size(levels->what->height, level));
    assert_int_equal(levels->seen[level][y], 0);
    levels->seen[level][y] = 1;
    memcpy(levels->made[level] + 4 * (size_t)y * width, rgba, 4 * width * sizeof *rgba);
    return SLUICE_SUCCESS;
}

static struct slc_pyramid_info info_of(const struct case_ *what, struct levels *levels)
{
    return (struct slc_pyramid_info){what->width,  what->height, what->filter, what->wrap_x,
                                     what->wrap_y, levels,       on_row};
}

static void push_all(struct slc_pyramid *pyramid, const struct levels *levels)
{
    for (uint32_t y = 0; y < levels->what->height; y++)
        CHECK_OK(slc_pyramid_push(pyramid, levels->made[0] + 4 * (size_t)y * levels->what->width));
}

static void make(struct levels *levels)
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_pyramid pyramid;
    struct slc_pyramid_info info = info_of(levels->what, levels);
    CHECK_OK(slc_pyramid_init(&pyramid, &cb, &info));
    push_all(&pyramid, levels);
    slc_pyramid_finish(&pyramid, &cb);
}

static void compare(const struct levels *levels, long double tolerance)
{
    const struct case_ *what = levels->what;
    for (uint32_t l = 1; l < levels->count; l++) {
        uint32_t width = slc_mip_size(what->width, l), height = slc_mip_size(what->height, l);
        for (uint32_t i = 0; i < 4 * width * height; i++)
            if (!(fabsl(levels->made[l][i] - levels->expected[l][i]) <= tolerance))
                fail_msg("%ux%u filter %d wrap %d %d level %u (%u, %u) channel %u: %.9Lg, not %.9g",
                         what->width, what->height, what->filter, what->wrap_x, what->wrap_y, l,
                         i / 4 % width, i / 4 / width, i % 4, levels->expected[l][i],
                         (double)levels->made[l][i]);
        for (uint32_t y = 0; y < height; y++)
            assert_int_equal(levels->seen[l][y], 1);
    }
}

static void check(const struct case_ *what, long double tolerance)
{
    struct levels levels;
    levels_init(&levels, what);
    for (uint32_t l = 1; l < levels.count; l++)
        expect_level(&levels, l);
    make(&levels);
    compare(&levels, tolerance);
    levels_finish(&levels);
}

static const uint32_t sizes[][2] = {{1, 1},  {2, 2},  {1, 37}, {64, 1}, {3, 3},   {5, 7},
                                    {17, 9}, {31, 2}, {16, 8}, {2, 61}, {29, 23}, {33, 34},
                                    {1, 2},  {3, 1},  {53, 7}, {7, 53}};

static void every_texel_is_the_mean_of_its_area(void **state)
{
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
        for (int wrap = 0; wrap < 9; wrap++) {
            struct case_ what = {sizes[s][0], sizes[s][1], SLUICE_BAKE_FILTER_BOX, wrap % 3,
                                 wrap / 3};
            check(&what, 1e-6L);
        }
}

static void wider_filters_see_the_other_edge_or_the_mirror_image(void **state)
{
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
        for (int wrap = 0; wrap < 3; wrap++) {
            struct case_ what = {sizes[s][0], sizes[s][1], SLUICE_BAKE_FILTER_KAISER, wrap,
                                 (wrap + 1) % 3};
            check(&what, 1e-3L);
        }
}

/* Pictures taller than the rows that are kept at the start. */
static void rows_that_wrap_around_come_last(void **state)
{
    (void)state;
    struct case_ what = {3, 333, SLUICE_BAKE_FILTER_KAISER, SLUICE_BAKE_WRAP_REPEAT,
                         SLUICE_BAKE_WRAP_REPEAT};
    check(&what, 1e-3L);
    what.height = 256;
    check(&what, 1e-3L);
}

static void a_second_pass_makes_the_same(void **state)
{
    (void)state;
    struct case_ what = {37, 131, SLUICE_BAKE_FILTER_KAISER, SLUICE_BAKE_WRAP_MIRROR,
                         SLUICE_BAKE_WRAP_REPEAT};
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_pyramid pyramid;
    struct levels first, second;
    levels_init(&first, &what);
    levels_init(&second, &what);
    make(&first);
    struct slc_pyramid_info info = info_of(&what, &second);
    CHECK_OK(slc_pyramid_init(&pyramid, &cb, &info));
    push_all(&pyramid, &second);
    slc_pyramid_rewind(&pyramid);
    for (uint32_t l = 0; l < second.count; l++)
        memset(second.seen[l], 0, slc_mip_size(what.height, l));
    push_all(&pyramid, &second);
    slc_pyramid_finish(&pyramid, &cb);
    for (uint32_t l = 1; l < first.count; l++)
        assert_memory_equal(first.made[l], second.made[l],
                            4 * sizeof(float) * slc_mip_size(what.width, l) *
                                slc_mip_size(what.height, l));
    levels_finish(&first);
    levels_finish(&second);
}

static void memory_is_what_was_said_and_grows_with_the_width_alone(void **state)
{
    (void)state;
    for (int filter = 0; filter < 2; filter++) {
        struct case_ what = {4099, 4099, filter, SLUICE_BAKE_WRAP_REPEAT, SLUICE_BAKE_WRAP_REPEAT};
        struct failing_allocator allocator;
        struct slc_pyramid pyramid;
        struct slc_pyramid_info info = info_of(&what, NULL);
        failing_allocator_init(&allocator, UINT64_MAX);
        CHECK_OK(slc_pyramid_init(&pyramid, &allocator.callbacks, &info));
        assert_int_equal(allocator.live_bytes, slc_pyramid_memory(&info));
        slc_pyramid_finish(&pyramid, &allocator.callbacks);
        assert_int_equal(allocator.live_bytes, 0);
        uint64_t size = slc_pyramid_memory(&info);
        info.height = 1u << 20;
        assert_true(slc_pyramid_memory(&info) < size + size / 8);
    }
}

static void no_memory_is_an_ordinary_result(void **state)
{
    (void)state;
    struct case_ what = {37, 29, SLUICE_BAKE_FILTER_KAISER, 0, 0};
    struct slc_pyramid_info info = info_of(&what, NULL);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        struct slc_pyramid pyramid;
        failing_allocator_init(&allocator, n);
        result = slc_pyramid_init(&pyramid, &allocator.callbacks, &info);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        slc_pyramid_finish(&pyramid, &allocator.callbacks);
        assert_int_equal(allocator.live_count, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_is_the_mean_of_its_area),
        cmocka_unit_test(wider_filters_see_the_other_edge_or_the_mirror_image),
        cmocka_unit_test(rows_that_wrap_around_come_last),
        cmocka_unit_test(a_second_pass_makes_the_same),
        cmocka_unit_test(memory_is_what_was_said_and_grows_with_the_width_alone),
        cmocka_unit_test(no_memory_is_an_ordinary_result),
    };
    return RUN_TESTS(tests);
}
