/* Conversions of texels over the whole range of float: the largest error of each, in steps of the
 * format. */
#include "extremes/extremes.h"

#include "base/alloc.h"
#include "image/convert.h"
#include "image/half.h"
#include "image/mip.h"
#include "image/small_float.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

static double half_value(uint32_t half)
{
    int exponent = half >> 10 & 31;
    double mantissa = half & 0x3FF;
    double magnitude = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    if (exponent == 31)
        magnitude = mantissa > 0 ? NAN : INFINITY;
    return half & 0x8000 ? -magnitude : magnitude;
}

/* Distance from a half to the next one, at a value. */
static double half_step(double value)
{
    int exponent = 0;
    frexp(value, &exponent);
    return ldexp(1, (exponent < -13 ? -13 : exponent) - 11);
}

/* Error in steps. Saturation and NaN follow half.h. */
static double half_error(double value, uint16_t half)
{
    double got = half_value(half);
    if (isnan(value))
        return half ? INFINITY : 0;
    if (fabs(value) >= 65504)
        return got == copysign(65504, value) ? 0 : INFINITY;
    if (signbit(value) != signbit(got))
        return INFINITY;
    double error = fabs(got - value) / half_step(value);
    return error == 0.5 && half & 1 ? INFINITY : error; /* ties to even */
}

static void every_half_becomes_itself(void **state)
{
    (void)state;
    struct extremes_row row = {.name = "c.float_from_half.value", .unit = "relative"};
    for (uint32_t half = 0; half < 65536; half++) {
        double value = half_value(half), got = (double)slc_float_from_half((uint16_t)half);
        bool same = isnan(value) ? isnan(got) : got == value && !signbit(got) == !signbit(value);
        extremes_add(&row, same ? 0 : INFINITY, "%04x", half);
    }
    extremes_end(&row);
}

/* The long form tests every float. */
static void floats_become_the_nearest_half(void **state)
{
    (void)state;
    struct extremes_row row = {.name = "c.half_from_float.rounding", .unit = "steps", .bound = 0.5};
    uint64_t count = extremes_count(1 << 20, 1ull << 32);
    for (uint64_t i = 0; i < count; i++) {
        float value = extremes_are_long() ? extremes_float_of((uint32_t)i) : extremes_float(i);
        double error = half_error((double)value, slc_half_from_float(value));
        if (error > row.worst || row.cases == 0)
            extremes_add(&row, error, "%a", (double)value);
        else
            row.cases++;
    }
    extremes_end(&row);
}

/* Returns a special half, or one of `count` evenly spaced ones. */
static uint16_t some_half(uint32_t i, uint32_t count)
{
    static const uint16_t halves[] = {0,      0x8000, 1,      0x8001, 0x3FF,  0x400,  0x3C00,
                                      0x3C01, 0x7BFF, 0xFBFF, 0x7C00, 0xFC00, 0x7E00, 0x7BFE};
    const uint32_t special = sizeof halves / sizeof halves[0];
    return i < special ? halves[i] : (uint16_t)((uint64_t)i * 65536 / count + i % 3);
}

/* Infinities of equal sign stay. Infinities of opposite signs give NaN, which counts as 0. */
static double exact_mean(double a, double b)
{
    return ((isnan(a) ? 0 : a) + (isnan(b) ? 0 : b)) / 2;
}

static void check_pairs(struct slc_mip_chain *chain, const SluiceAllocationCallbacks *cb,
                        uint32_t first, uint32_t count, struct extremes_row *row)
{
    uint16_t *texels = (uint16_t *)slc_mip_chain_level(chain, 0);
    for (uint32_t i = 0; i < count; i++) {
        texels[2 * i] = some_half(first, count);
        texels[2 * i + 1] = some_half(i, count);
    }
    CHECK_OK(slc_mip_chain_build(chain, cb));
    const uint16_t *means = (const uint16_t *)slc_mip_chain_level(chain, 1);
    for (uint32_t i = 0; i < count; i++) {
        double a = half_value(texels[2 * i]), b = half_value(texels[2 * i + 1]);
        double mean = exact_mean(a, b), error = half_error(mean, means[i]);
        if (mean == 0 && means[i] == 0)
            error = 0; /* zero of either sign */
        if (error > row->worst || row->cases == 0)
            extremes_add(row, error, "%04x and %04x", texels[2 * i], texels[2 * i + 1]);
        else
            row->cases++;
    }
}

static void means_of_pairs_of_halves_are_nearest(void **state)
{
    (void)state;
    struct extremes_row row = {
        .name = "c.mip_of_half_pairs.rounding", .unit = "steps", .bound = 0.501};
    uint32_t count = (uint32_t)extremes_count(1024, 16384);
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_mip_chain chain;
    CHECK_OK(slc_mip_chain_init(&chain, &cb, SLUICE_FORMAT_R16_SFLOAT, 2 * count, 1));
    for (uint32_t i = 0; i < count; i++)
        check_pairs(&chain, &cb, i, count, &row);
    slc_mip_chain_finish(&chain, &cb);
    extremes_end(&row);
}

/* Step at a value of an unsigned float with 5 bits of exponent. */
static double small_step(double value, int mantissa_bits)
{
    int exponent = 0;
    frexp(value, &exponent);
    return ldexp(1, (exponent < -13 ? -13 : exponent) - 1 - mantissa_bits);
}

static double bounded(double value, double high)
{
    return !(value > 0) ? 0 : value > high ? high : value;
}

static double encode(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

struct conversion {
    const char *name;
    SluiceFormat format;
    double (*error)(const float rgba[4], const float got[4]); ///< in steps
    double bound;
};

static double unorm_error(const float *rgba, const float *got, double steps)
{
    return fabs(bounded((double)rgba[0], 1) - (double)got[0]) * steps;
}

static double byte_error(const float rgba[4], const float got[4])
{
    return unorm_error(rgba, got, 255);
}

static double ten_bit_error(const float rgba[4], const float got[4])
{
    return unorm_error(rgba, got, 1023);
}

static double srgb_error(const float rgba[4], const float got[4])
{
    return fabs(encode(bounded((double)rgba[0], 1)) - encode((double)got[0])) * 255;
}

static double ufloat_error(const float rgba[4], const float got[4])
{
    const double high[3] = {65024, 65024, 64512};
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        double wanted = bounded((double)rgba[c], high[c]);
        worst = fmax(worst, fabs(wanted - (double)got[c]) / small_step(wanted, c == 2 ? 5 : 6));
    }
    return worst;
}

/* Returns the error in steps. All components share an exponent; the step is that of the largest. */
static double shared_error(const float rgba[4], const float got[4])
{
    double wanted[3], largest = 0, worst = 0;
    for (int c = 0; c < 3; c++) {
        wanted[c] = bounded((double)rgba[c], 65408);
        largest = fmax(largest, wanted[c]);
    }
    int exponent = 0;
    frexp(largest, &exponent);
    double step = ldexp(1, (largest > 0 && exponent > -15 ? exponent : -15) - 9);
    if (largest >= 511.5 * step)
        step *= 2;
    for (int c = 0; c < 3; c++)
        worst = fmax(worst, fabs(wanted[c] - (double)got[c]) / step);
    return worst;
}

static double float_error(const float rgba[4], const float got[4])
{
    double worst = 0;
    for (int c = 0; c < 4; c++)
        worst += extremes_bits_of(rgba[c]) != extremes_bits_of(got[c]);
    return worst;
}

/* Half a step; slightly more if floats carry the decoded value. */
static const struct conversion conversions[] = {
    {"c.r8_unorm.rounding", SLUICE_FORMAT_R8_UNORM, byte_error, 0.50002},
    {"c.a2b10g10r10_unorm.rounding", SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32, ten_bit_error, 0.5001},
    {"c.r8g8b8a8_srgb.rounding", SLUICE_FORMAT_R8G8B8A8_SRGB, srgb_error, 0.5003},
    {"c.b10g11r11_ufloat.rounding", SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32, ufloat_error, 0.5},
    {"c.e5b9g9r9_ufloat.rounding", SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32, shared_error, 0.5},
    {"c.r32_sfloat.rounding", SLUICE_FORMAT_R32G32B32A32_SFLOAT, float_error, 0},
};

/* Numbers from the whole range of float, and as many from 0 to 1, where most steps are. */
static void make_color(uint64_t i, float rgba[4])
{
    for (uint64_t c = 0; c < 4; c++) {
        rgba[c] = extremes_float(i * 4 + c);
        if (i % 2)
            rgba[c] = (float)extremes_random(i * 4 + c) / 4294967296.0f;
        if (i % 8 == 3)
            rgba[c] = ((float)(extremes_random(i + c) % 1023) + 0.5f) / 1023.0f;
    }
    if (i % 4 == 1)
        rgba[0] = extremes_specials[i / 4 % EXTREMES_SPECIALS];
}

static void every_format_rounds_to_the_nearest(void **state)
{
    (void)state;
    for (size_t f = 0; f < sizeof conversions / sizeof conversions[0]; f++) {
        const struct conversion *c = &conversions[f];
        struct extremes_row row = {.name = c->name, .unit = "steps", .bound = c->bound};
        uint64_t count = extremes_count(200000, 10000000);
        for (uint64_t i = 0; i < count; i++) {
            float rgba[4], got[4];
            char texel[16];
            make_color(i, rgba);
            slc_texels_from_rgba(c->format, rgba, texel, 1);
            slc_texels_to_rgba(c->format, texel, got, 1);
            extremes_add(&row, c->error(rgba, got), "%a %a %a", (double)rgba[0], (double)rgba[1],
                         (double)rgba[2]);
        }
        extremes_end(&row);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_becomes_itself),
        cmocka_unit_test(floats_become_the_nearest_half),
        cmocka_unit_test(means_of_pairs_of_halves_are_nearest),
        cmocka_unit_test(every_format_rounds_to_the_nearest),
    };
    return extremes_begin(argc, argv) ? RUN_TESTS(tests) : 2;
}
