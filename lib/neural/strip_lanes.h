/** Vector arithmetic for strips. */
#ifndef SLC_NEURAL_STRIP_LANES_H
#define SLC_NEURAL_STRIP_LANES_H

#include "neural/strip.h"

#if defined(__AVX2__) || defined(__SSE2__)
#include <immintrin.h>
#endif

/* Returns the sum of the products of the signed low and high halves. */
static inline slc_words multiply_pairs(slc_words a, slc_words b)
{
#if defined(__AVX2__) && SLC_STRIP_LANES == 8
    return (slc_words)_mm256_madd_epi16((__m256i)a, (__m256i)b);
#elif defined(__SSE2__) && SLC_STRIP_LANES == 4
    return (slc_words)_mm_madd_epi16((__m128i)a, (__m128i)b);
#else
    slc_ints low = ((slc_ints)(a << 16) >> 16) * ((slc_ints)(b << 16) >> 16);
    return (slc_words)(low + ((slc_ints)a >> 16) * ((slc_ints)b >> 16));
#endif
}

static inline slc_floats select_lanes(slc_ints mask, slc_floats yes, slc_floats no)
{
    return (slc_floats)(((slc_ints)yes & mask) | ((slc_ints)no & ~mask));
}

/* Rounds to half like slc_half_from_float, except that numbers above 65504 do not overflow. */
static inline slc_floats round_to_half(slc_floats value)
{
    slc_words bits = (slc_words)value, sign = bits & 0x80000000u, size = bits ^ sign;
    slc_floats normal = (slc_floats)((size + 0xFFF + (size >> 13 & 1)) & ~0x1FFFu);
    slc_floats small = ((slc_floats)size + 0.5f) - 0.5f; /* multiples of 2^-24 */
    slc_floats rounded = select_lanes((slc_floats)size < 0x1p-14f, small, normal);
    rounded = (slc_floats)((slc_words)rounded | sign);
    return select_lanes(value == value, rounded, (slc_floats){0}); /* NaN: 0 */
}

/* Rounds to E4M3 like slc_e4m3_from_float. */
static inline slc_floats round_to_e4m3(slc_floats value)
{
    slc_words bits = (slc_words)value, sign = bits & 0x80000000u, size = bits ^ sign;
    slc_floats normal = (slc_floats)((size + 0x7FFFF + (size >> 20 & 1)) & ~0xFFFFFu);
    slc_floats small = ((slc_floats)size + 0x1p14f) - 0x1p14f; /* multiples of 2^-9 */
    slc_floats rounded = select_lanes((slc_floats)size < 0x1p-6f, small, normal);
    slc_floats most = (slc_floats){0} + 448.0f;
    rounded = select_lanes((slc_floats)size < 448.0f, rounded, most);
    return (slc_floats)((slc_words)rounded | sign);
}

/* Activation of the format: a cubic GELU, clamped to 3. */
static inline slc_floats activate_lanes(slc_floats r)
{
    const slc_floats zero = {0}, one = zero + 1.0f, three = zero + 3.0f;
    slc_floats t = r * 0.333333f + 0.5f;
    t = select_lanes(t < zero, zero, select_lanes(one < t, one, t));
    return select_lanes(r < three, r, three) * t;
}

/* Converts -0.1875..3 to codes. Adding 1.5 * 2^23 rounds to nearest, ties to even. */
static inline slc_words codes_of(slc_floats y)
{
    return (slc_words)(y * 80.0f + 12582912.0f) - (0x4B400000u + 113u);
}

#endif /* SLC_NEURAL_STRIP_LANES_H */
