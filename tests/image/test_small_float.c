/* Compares every conversion with a search over all values of the format. */
#include "image/convert.h"
#include "image/small_float.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

/* Value of a code in double, by the specification. */
static double ufloat_value(uint32_t code, uint32_t mantissa_bits)
{
    uint32_t exponent = code >> mantissa_bits, mantissa = code & ((1u << mantissa_bits) - 1);
    double one = (double)(1u << mantissa_bits);
    if (exponent == 31)
        return mantissa ? NAN : INFINITY;
    return exponent ? (1 + mantissa / one) * pow(2, (int)exponent - 15) : mantissa / one * 0x1p-14;
}

static void ufloats_decode_as_specified(void **state)
{
    (void)state;
    for (uint32_t bits = 5; bits <= 6; bits++)
        for (uint32_t code = 0; code < 32u << bits; code++) {
            double expected = ufloat_value(code, bits);
            float value = slc_float_from_ufloat(code, bits);
            assert_true(isnan(expected) ? isnan(value) : (double)value == expected);
        }
}

/* Returns the finite code with the nearest value; the even one of two equally near ones. */
static uint32_t nearest_ufloat(double value, uint32_t bits)
{
    uint32_t best = 0;
    for (uint32_t code = 1; code < 31u << bits; code++) {
        double gain =
            fabs(ufloat_value(best, bits) - value) - fabs(ufloat_value(code, bits) - value);
        if (gain > 0 || (gain == 0 && code % 2 == 0))
            best = code;
    }
    return best;
}

static void ufloats_round_to_the_nearest_code(void **state)
{
    (void)state;
    for (uint32_t bits = 5; bits <= 6; bits++)
        for (uint32_t code = 0; code<31u << bits; code += code> 200 ? 7 : 1) {
            float here = (float)ufloat_value(code, bits);
            float middle = (float)((ufloat_value(code, bits) + ufloat_value(code + 1, bits)) / 2);
            if (isinf(middle))
                middle = 1.5f * here;
            const float tries[] = {here,   nextafterf(here, 0),   nextafterf(here, 1e9f),
                                   middle, nextafterf(middle, 0), nextafterf(middle, 1e9f)};
            for (size_t i = 0; i < sizeof tries / sizeof tries[0]; i++)
                assert_int_equal(slc_ufloat_from_float(tries[i], bits),
                                 nearest_ufloat((double)tries[i], bits));
        }
}

static void ufloats_saturate_and_have_no_sign(void **state)
{
    (void)state;
    for (uint32_t bits = 5; bits <= 6; bits++) {
        uint32_t largest = (31u << bits) - 1;
        assert_int_equal(slc_ufloat_from_float(INFINITY, bits), largest);
        assert_int_equal(slc_ufloat_from_float(1e30f, bits), largest);
        assert_int_equal(slc_ufloat_from_float(-1.0f, bits), 0);
        assert_int_equal(slc_ufloat_from_float(-INFINITY, bits), 0);
        assert_int_equal(slc_ufloat_from_float(-0.0f, bits), 0);
        assert_int_equal(slc_ufloat_from_float(NAN, bits), 0);
        assert_int_equal(slc_ufloat_from_float(1e-40f, bits), 0);
    }
}

static double shared_value(uint32_t texel, int channel)
{
    return (double)(texel >> (9 * channel) & 511) * pow(2, (int)(texel >> 27) - 24);
}

/*
 * Checks a shared exponent: it is the smallest one for which the largest channel, rounded, has a
 * mantissa. Each channel is a nearest multiple of its step.
 */
static void check_shared(const float rgb[3])
{
    uint32_t texel = slc_e5b9g9r9_from_float(rgb), exponent = 0;
    double largest = fmax((double)rgb[0], fmax((double)rgb[1], (double)rgb[2]));
    while (largest / pow(2, (int)exponent - 24) >= 511.5)
        exponent++;
    assert_int_equal(texel >> 27, exponent);
    double step = pow(2, (int)exponent - 24);
    for (int c = 0; c < 3; c++) {
        double error = (double)rgb[c] - shared_value(texel, c);
        assert_true(error >= -0.5 * step && error < 0.5 * step); /* ties go up */
    }
}

static void shared_exponent_texels_are_nearest(void **state)
{
    (void)state;
    uint32_t random = 1;
    for (int i = 0; i < 200000; i++) {
        float rgb[3];
        for (int c = 0; c < 3; c++) {
            random = random * 1664525u + 1013904223u;
            rgb[c] = ldexpf((float)(random >> 8), (int)(random % 45) - 56);
            if (rgb[c] > 65408.0f)
                rgb[c] = 65408.0f;
        }
        check_shared(rgb);
    }
    for (int exponent = -30; exponent < 16; exponent++) /* where the exponent changes */
        for (int side = 0; side < 3; side++) {
            float edge = ldexpf(1.0f - 0x1p-10f, exponent);
            float value = side == 0 ? edge : nextafterf(edge, side == 1 ? 0.0f : 1e9f);
            check_shared((const float[3]){value, value / 3, 0});
        }
}

static void shared_exponent_texels_decode_as_specified(void **state)
{
    (void)state;
    uint32_t random = 1;
    for (int i = 0; i < 100000; i++) {
        random = random * 1664525u + 1013904223u;
        uint32_t texel = random ^ random >> 13;
        float rgb[3];
        slc_float_from_e5b9g9r9(texel, rgb);
        for (int c = 0; c < 3; c++)
            assert_true((double)rgb[c] == shared_value(texel, c));
    }
}

static void shared_exponent_texels_clamp(void **state)
{
    (void)state;
    float rgb[3];
    uint32_t texel = slc_e5b9g9r9_from_float((const float[3]){INFINITY, -3.0f, NAN});
    slc_float_from_e5b9g9r9(texel, rgb);
    assert_true(rgb[0] == 65408.0f && rgb[1] == 0.0f && rgb[2] == 0.0f);
    assert_int_equal(slc_e5b9g9r9_from_float((const float[3]){0, -0.0f, -INFINITY}), 0);
    assert_int_equal(slc_e5b9g9r9_from_float((const float[3]){1, 1, 1}),
                     16u << 27 | 256u << 18 | 256u << 9 | 256u);
}

static uint32_t texel_of(SluiceFormat format, const float rgba[4])
{
    uint32_t texel;
    slc_texels_from_rgba(format, rgba, &texel, 1);
    return texel;
}

static void packed_channels_have_vulkans_places(void **state)
{
    (void)state;
    const SluiceFormat unorm = SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32;
    const SluiceFormat ufloat = SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32;
    const SluiceFormat shared = SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32;
    static const float units[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    assert_int_equal(texel_of(unorm, units[0]), 0x3FFu);
    assert_int_equal(texel_of(unorm, units[1]), 0x3FFu << 10);
    assert_int_equal(texel_of(unorm, units[2]), 0x3FFu << 20);
    assert_int_equal(texel_of(unorm, units[3]), 3u << 30);
    assert_int_equal(texel_of(ufloat, units[0]), 15u << 6);
    assert_int_equal(texel_of(ufloat, units[1]), 15u << 17);
    assert_int_equal(texel_of(ufloat, units[2]), 15u << 27);
    assert_int_equal(texel_of(ufloat, units[3]), 0);
    assert_int_equal(texel_of(shared, units[0]), 16u << 27 | 256u);
    assert_int_equal(texel_of(shared, units[1]), 16u << 27 | 256u << 9);
    assert_int_equal(texel_of(shared, units[2]), 16u << 27 | 256u << 18);
    assert_int_equal(texel_of(shared, units[3]), 0);
}

static void ten_and_two_bits_round_to_the_nearest_step(void **state)
{
    (void)state;
    const SluiceFormat format = SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32;
    for (int i = -5; i < 3000; i++) {
        float value = (float)i / 2900.0f;
        uint32_t texel = texel_of(format, (const float[4]){value, 0, 0, value});
        double clamped = fmin(fmax((double)value, 0), 1);
        assert_true(fabs(clamped * 1023 - (texel & 1023)) <= 0.5);
        assert_true(fabs(clamped * 3 - (texel >> 30)) <= 0.5);
    }
    assert_int_equal(texel_of(format, (const float[4]){NAN, INFINITY, -INFINITY, 2}),
                     0x3FFu << 10 | 3u << 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ufloats_decode_as_specified),
        cmocka_unit_test(ufloats_round_to_the_nearest_code),
        cmocka_unit_test(ufloats_saturate_and_have_no_sign),
        cmocka_unit_test(shared_exponent_texels_are_nearest),
        cmocka_unit_test(shared_exponent_texels_decode_as_specified),
        cmocka_unit_test(shared_exponent_texels_clamp),
        cmocka_unit_test(packed_channels_have_vulkans_places),
        cmocka_unit_test(ten_and_two_bits_round_to_the_nearest_step),
    };
    return RUN_TESTS(tests);
}
