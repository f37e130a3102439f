#include "base/alloc.h"
#include "base/checked.h"
#include "image/convert.h"
#include "image/mip.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t next_random(uint32_t *random)
{
    return *random = *random * 1664525u + 1013904223u;
}

static void fill(struct slc_mip_chain *chain, uint32_t *random)
{
    float rgba[4];
    size_t texel_size = sluiceGetFormatTexelSize(chain->format);
    size_t count = (size_t)chain->width * chain->height;
    for (size_t i = 0; i < count; i++) {
        for (int c = 0; c < 4; c++)
            rgba[c] = (float)(next_random(random) >> 8) * 0x1p-24f;
        slc_texels_from_rgba(chain->format, rgba, chain->texels + i * texel_size, 1);
    }
}

static void load(const struct slc_mip_chain *chain, uint32_t level, uint32_t x, uint32_t y,
                 float rgba[4])
{
    size_t width = slc_mip_size(chain->width, level);
    size_t texel_size = sluiceGetFormatTexelSize(chain->format);
    const char *texel = slc_mip_chain_level(chain, level) + (y * width + x) * texel_size;
    slc_texels_to_rgba(chain->format, texel, rgba, 1);
}

/* Returns the share of the source texel `s` that the texel `i` of the level below covers. */
static long double overlap(uint32_t size, uint32_t below, uint32_t i, uint32_t s)
{
    long double scale = (long double)size / below;
    long double low = fmaxl(i * scale, s), high = fminl((i + 1) * scale, s + 1.0L);
    return high > low ? (high - low) / scale : 0;
}

/* Every source texel of the level above, weighted by area: brute force. */
static long double mean(const struct slc_mip_chain *chain, uint32_t level, uint32_t x, uint32_t y,
                        int c)
{
    uint32_t width = slc_mip_size(chain->width, level - 1);
    uint32_t height = slc_mip_size(chain->height, level - 1);
    long double sum = 0;
    for (uint32_t v = 0; v < height; v++) {
        long double row = overlap(height, slc_mip_size(chain->height, level), y, v);
        for (uint32_t u = 0; u < width && row > 0; u++) {
            long double weight = row * overlap(width, slc_mip_size(chain->width, level), x, u);
            float rgba[4];
            if (weight <= 0)
                continue;
            load(chain, level - 1, u, v, rgba);
            sum += weight * rgba[c];
        }
    }
    return sum;
}

/* Half a step of the format around a linear value, and a little for arithmetic. */
static long double tolerance(SluiceFormat format, int c, long double value)
{
    if (format == SLUICE_FORMAT_R32_SFLOAT || format == SLUICE_FORMAT_R32G32B32A32_SFLOAT)
        return fabsl(value) * FLT_EPSILON;
    if (format == SLUICE_FORMAT_R16G16B16A16_SFLOAT)
        return fmaxl(ldexpl(fabsl(value), -11), 0x1p-25L) * 1.0001L;
    if (format == SLUICE_FORMAT_R8G8B8A8_SRGB && c < 3) /* steepest where it is brightest */
        return value < 0.002L ? 0.5L / 255 / 12.92L * 1.01L
                              : 1.01L * 0.5L / 255 * 2.4L / 1.055L *
                                    powl((1.055L * powl(value, 1 / 2.4L) + 0.003L) / 1.055L, 1.4L);
    return 0.5L / 255 * 1.0001L;
}

static void check_chain(SluiceFormat format, uint32_t width, uint32_t height)
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_mip_chain chain;
    uint32_t random = width * 31 + height;
    CHECK_OK(slc_mip_chain_init(&chain, &cb, format, width, height));
    fill(&chain, &random);
    CHECK_OK(slc_mip_chain_build(&chain, &cb));
    for (uint32_t level = 1; level < chain.level_count; level++)
        for (uint32_t y = 0; y < slc_mip_size(height, level); y++)
            for (uint32_t x = 0; x < slc_mip_size(width, level); x++) {
                float rgba[4];
                load(&chain, level, x, y, rgba);
                for (int c = 0; c < (int)slc_format_channel_count(format); c++) {
                    long double expected = mean(&chain, level, x, y, c);
                    if (fabsl(expected - rgba[c]) > tolerance(format, c, expected))
                        fail_msg("%s %ux%u level %u (%u, %u) channel %d: %.9Lg, not %.9g",
                                 sluiceGetFormatName(format), width, height, level, x, y, c,
                                 expected, (double)rgba[c]);
                }
            }
    slc_mip_chain_finish(&chain, &cb);
}

static void every_texel_is_the_mean_of_its_area(void **state)
{
    (void)state;
    const uint32_t sizes[][2] = {{1, 1},  {2, 2},  {1, 37}, {64, 1},  {3, 3}, {5, 7},
                                 {17, 9}, {31, 2}, {16, 8}, {29, 23}, {2, 61}};
    const SluiceFormat formats[] = {SLUICE_FORMAT_R8_UNORM, SLUICE_FORMAT_R8G8B8A8_SRGB,
                                    SLUICE_FORMAT_R16G16B16A16_SFLOAT, SLUICE_FORMAT_R32_SFLOAT,
                                    SLUICE_FORMAT_R32G32B32A32_SFLOAT};
    for (size_t f = 0; f < sizeof formats / sizeof formats[0]; f++)
        for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
            check_chain(formats[f], sizes[s][0], sizes[s][1]);
}

static void make_chain(struct slc_mip_chain *chain, SluiceFormat format, uint32_t width,
                       uint32_t height)
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    size_t size = sluiceGetFormatTexelSize(format);
    uint32_t random = width * 31 + height;
    CHECK_OK(slc_mip_chain_init(chain, &cb, format, width, height));
    for (size_t i = 0; i < size * width * height; i++)
        chain->texels[i] = (char)(next_random(&random) >> 24);
}

/* Each texel of `numbers` is the number of a texel of level 0. Returns the largest distance of one
 * from the center of the area that it represents, relative to that area's width or height. */
static double farthest(const struct slc_mip_chain *numbers, uint32_t width, uint32_t height)
{
    double most = 0;
    for (uint32_t level = 0; level < numbers->level_count; level++) {
        const uint32_t *texels =
            (const uint32_t *)(const void *)slc_mip_chain_level(numbers, level);
        uint32_t w = slc_mip_size(width, level), h = slc_mip_size(height, level);
        for (uint32_t i = 0; i < w * h; i++) {
            double x = (texels[i] % width + 0.5) * w / width - (i % w + 0.5);
            double y = ((double)(texels[i] / width) + 0.5) * h / height - (i / w + 0.5);
            most = fmax(most, fmax(fabs(x), fabs(y)));
        }
    }
    return most;
}

/* Checks that a format picks the same texels as all others. */
static void check_picked(SluiceFormat format, const struct slc_mip_chain *numbers, uint32_t width,
                         uint32_t height)
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_mip_chain chain;
    size_t size = sluiceGetFormatTexelSize(format);
    make_chain(&chain, format, width, height);
    CHECK_OK(slc_mip_chain_build(&chain, &cb));
    for (uint32_t level = 1; level < chain.level_count; level++) {
        const uint32_t *texels =
            (const uint32_t *)(const void *)slc_mip_chain_level(numbers, level);
        uint32_t count = slc_mip_size(width, level) * slc_mip_size(height, level);
        for (uint32_t i = 0; i < count; i++)
            assert_memory_equal(slc_mip_chain_level(&chain, level) + i * size,
                                chain.texels + texels[i] * size, size);
    }
    slc_mip_chain_finish(&chain, &cb);
}

static void integers_are_those_near_the_center_of_their_area(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height;
        double farthest;
    } cases[] = {{1, 1, 0},   {2, 2, 0.25},     {1, 37, 0.4},  {64, 1, 0.25}, {3, 3, 0.4},
                 {5, 7, 0.4}, {128, 256, 0.25}, {29, 23, 0.4}, {16, 8, 0.25}, {100, 36, 0.4}};
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        SluiceAllocationCallbacks cb = slc_allocator(NULL);
        struct slc_mip_chain numbers;
        uint32_t width = cases[c].width, height = cases[c].height;
        CHECK_OK(slc_mip_chain_init(&numbers, &cb, SLUICE_FORMAT_R32_UINT, width, height));
        for (uint32_t i = 0; i < width * height; i++)
            memcpy(numbers.texels + 4 * i, &i, 4);
        CHECK_OK(slc_mip_chain_build(&numbers, &cb));
        double off = farthest(&numbers, width, height);
        if (off > cases[c].farthest)
            fail_msg("%u x %u: %g of a texel off, %g allowed", width, height, off,
                     cases[c].farthest);
        for (uint32_t f = SLUICE_FORMAT_R8_UINT; f <= SLUICE_FORMAT_R32G32B32A32_SINT; f++)
            check_picked((SluiceFormat)f, &numbers, width, height);
        slc_mip_chain_finish(&numbers, &cb);
    }
}

static void srgb_averages_light_not_codes(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_mip_chain chain;
    CHECK_OK(slc_mip_chain_init(&chain, &cb, SLUICE_FORMAT_R8G8B8A8_SRGB, 2, 1));
    memcpy(chain.texels, ((uint8_t[8]){0, 0, 0, 0, 255, 255, 255, 255}), 8);
    CHECK_OK(slc_mip_chain_build(&chain, &cb));
    /* half the light is 188 in sRGB; alpha is linear */
    assert_memory_equal(slc_mip_chain_level(&chain, 1), ((uint8_t[4]){188, 188, 188, 128}), 4);
    slc_mip_chain_finish(&chain, &cb);
}

static float mean_of_two(SluiceFormat format, float a, float b)
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_mip_chain chain;
    CHECK_OK(slc_mip_chain_init(&chain, &cb, format, 1, 2));
    const float texels[2][4] = {{a}, {b}};
    size_t texel_size = sluiceGetFormatTexelSize(format);
    if (format == SLUICE_FORMAT_R32_SFLOAT) {
        memcpy(chain.texels, &a, 4);
        memcpy(chain.texels + 4, &b, 4);
    } else {
        slc_texels_from_rgba(format, texels[0], chain.texels, 1);
        slc_texels_from_rgba(format, texels[1], chain.texels + texel_size, 1);
    }
    CHECK_OK(slc_mip_chain_build(&chain, &cb));
    float rgba[4];
    slc_texels_to_rgba(format, slc_mip_chain_level(&chain, 1), rgba, 1);
    slc_mip_chain_finish(&chain, &cb);
    return rgba[0];
}

static void nan_counts_as_zero_and_no_level_below_holds_one(void **state)
{
    (void)state;
    SluiceFormat f32 = SLUICE_FORMAT_R32_SFLOAT;
    assert_true(mean_of_two(f32, NAN, 3.0f) == 1.5f);
    assert_true(mean_of_two(f32, NAN, NAN) == 0.0f);
    assert_true(mean_of_two(f32, INFINITY, -INFINITY) == 0.0f);
    assert_true(mean_of_two(f32, INFINITY, 1.0f) == INFINITY);
    assert_true(mean_of_two(f32, FLT_MAX, FLT_MAX) == FLT_MAX);
    assert_true(mean_of_two(SLUICE_FORMAT_R16_SFLOAT, 65504.0f, 65504.0f) == 65504.0f);
}

static void running_out_of_memory_is_a_result_and_leaves_nothing(void **state)
{
    (void)state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        struct slc_mip_chain chain;
        assert_true(n < 100);
        failing_allocator_init(&allocator, n);
        result = slc_mip_chain_init(&chain, &allocator.callbacks, SLUICE_FORMAT_R8_UNORM, 9, 5);
        if (result == SLUICE_SUCCESS) {
            memset(chain.texels, 0, chain.size);
            result = slc_mip_chain_build(&chain, &allocator.callbacks);
        }
        assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        slc_mip_chain_finish(&chain, &allocator.callbacks);
        assert_int_equal(allocator.live_bytes, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_is_the_mean_of_its_area),
        cmocka_unit_test(integers_are_those_near_the_center_of_their_area),
        cmocka_unit_test(srgb_averages_light_not_codes),
        cmocka_unit_test(nan_counts_as_zero_and_no_level_below_holds_one),
        cmocka_unit_test(running_out_of_memory_is_a_result_and_leaves_nothing),
    };
    return RUN_TESTS(tests);
}
