#include "image/half.h"
#include "support/test.h"

#include <math.h>

/* Straight from the definition of the format. */
static long double half_value(uint16_t half)
{
    int exponent = half >> 10 & 0x1F;
    long double mantissa = half & 0x3FF;
    long double magnitude =
        exponent ? ldexpl(1024 + mantissa, exponent - 25) : ldexpl(mantissa, -24);
    return half & 0x8000 ? -magnitude : magnitude;
}

static bool is_nan(uint16_t half)
{
    return (half & 0x7FFF) > 0x7C00;
}

static void every_half_widens_exactly(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 65536; h++) {
        float value = slc_float_from_half((uint16_t)h);
        if (is_nan((uint16_t)h)) {
            assert_true(isnan(value));
            assert_int_equal(slc_float_bits(value) >> 13 & 0x3FF, h & 0x3FF);
        } else if ((h & 0x7FFF) == 0x7C00) {
            assert_true(isinf(value) && !!signbit(value) == (h >> 15));
        } else {
            assert_true((long double)value == half_value((uint16_t)h));
            assert_int_equal(!!signbit(value), h >> 15);
        }
    }
}

static void every_half_survives_a_round_trip(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 65536; h++) {
        uint16_t back = slc_half_from_float(slc_float_from_half((uint16_t)h));
        if (is_nan((uint16_t)h))
            assert_int_equal(back, 0);
        else if ((h & 0x7FFF) == 0x7C00)
            assert_int_equal(back, (h & 0x8000) | 0x7BFF);
        else
            assert_int_equal(back, h);
    }
}

/* Nearest by a search over all finite halves of the sign, ties to the even one. */
static uint16_t nearest_half(float value)
{
    uint16_t sign = signbit(value) ? 0x8000 : 0;
    long double magnitude = fabsl((long double)value);
    uint16_t low = 0, high = 0x7BFF;
    if (magnitude >= half_value(high))
        return sign | high;
    while (high - low > 1) {
        uint16_t middle = (uint16_t)((low + high) / 2);
        if (half_value(middle) <= magnitude)
            low = middle;
        else
            high = middle;
    }
    long double below = magnitude - half_value(low), above = half_value(high) - magnitude;
    if (below == above)
        return sign | (low % 2 == 0 ? low : high);
    return sign | (below < above ? low : high);
}

static void check(float value)
{
    uint16_t expected = isnan(value) ? 0 : nearest_half(value);
    if (slc_half_from_float(value) != expected)
        fail_msg("%a gives %04x, not %04x", (double)value, slc_half_from_float(value), expected);
}

static void floats_of_every_exponent_round_to_nearest_even(void **state)
{
    (void)state;
    uint32_t random = 1;
    for (uint32_t top = 0; top < 512; top++) /* sign and exponent */
        for (int i = 0; i < 400; i++) {
            random = random * 1664525u + 1013904223u;
            check(slc_float_from_bits(top << 23 | random >> 9));
        }
}

static void ties_and_their_neighbors_round_right(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 0x7BFF; h++) {
        float tie = (float)((half_value((uint16_t)h) + half_value((uint16_t)(h + 1))) / 2);
        for (int sign = -1; sign <= 1; sign += 2) {
            check((float)sign * tie);
            check((float)sign * nextafterf(tie, 0.0f));
            check((float)sign * nextafterf(tie, INFINITY));
        }
    }
}

static void the_ends_saturate_and_nan_becomes_zero(void **state)
{
    (void)state;
    const float ends[] = {0.0f,     -0.0f,    65504.0f, 65519.9f,   65520.0f, 65536.0f,  3.4e38f,
                          INFINITY, 0x1p-24f, 0x1p-25f, 0x1.8p-25f, 0x1p-26f, 0x1p-149f, 0x1p-14f};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        check(ends[i]);
        check(-ends[i]);
    }
    assert_int_equal(slc_half_from_float(INFINITY), 0x7BFF);
    assert_int_equal(slc_half_from_float(-INFINITY), 0xFBFF);
    assert_int_equal(slc_half_from_float(NAN), 0);
    assert_int_equal(slc_half_from_float(-NAN), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_widens_exactly),
        cmocka_unit_test(every_half_survives_a_round_trip),
        cmocka_unit_test(floats_of_every_exponent_round_to_nearest_even),
        cmocka_unit_test(ties_and_their_neighbors_round_right),
        cmocka_unit_test(the_ends_saturate_and_nan_becomes_zero),
    };
    return RUN_TESTS(tests);
}
