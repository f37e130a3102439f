/** The float formats without a sign: 11 and 10 bits, and three channels that share an exponent. */
#ifndef SLC_IMAGE_SMALL_FLOAT_H
#define SLC_IMAGE_SMALL_FLOAT_H

#include "image/half.h"

/** 5 bits of exponent above `mantissa_bits` (6 or 5) of mantissa; exact, infinity and NaN too. */
static inline float slc_float_from_ufloat(uint32_t ufloat, uint32_t mantissa_bits)
{
    /* Small floats are halves without sign, whose mantissa lacks its low bits. */
    return slc_float_from_half((uint16_t)(ufloat << (10 - mantissa_bits)));
}

/** Rounds to nearest even, saturates at the largest finite value; 0 for negative values and NaN. */
static inline uint32_t slc_ufloat_from_float(float value, uint32_t mantissa_bits)
{
    uint32_t dropped = 23 - mantissa_bits;
    uint32_t bits = slc_float_bits(value);
    uint32_t max = (0x1Fu << mantissa_bits) - 1; /* the exponent 31 is infinity's */
    if (!(value > 0.0f))
        return 0;
    if (bits >= (max << dropped) + 0x38000000u)
        return max;
    if (bits < 0x38800000u) { /* below 2^-14: the addition rounds to a multiple of the smallest */
        float magic = mantissa_bits == 6 ? 0x1p3f : 0x1p4f;
        return slc_float_bits(value + magic) - slc_float_bits(magic);
    }
    uint32_t odd = bits >> dropped & 1;
    return (bits - 0x38000000u + (1u << (dropped - 1)) - 1 + odd) >> dropped;
}

/** Bits 0, 9 and 18: mantissas of R, G and B; bit 27: exponent. NaN and below 0 become 0. */
uint32_t slc_e5b9g9r9_from_float(const float rgb[3]);

/** Decodes a texel exactly. */
void slc_float_from_e5b9g9r9(uint32_t texel, float rgb[3]);

#endif /* SLC_IMAGE_SMALL_FLOAT_H */
