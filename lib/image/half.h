/** IEEE 754 half precision: exact widening, and narrowing rounded to nearest even. */
#ifndef SLC_IMAGE_HALF_H
#define SLC_IMAGE_HALF_H

#include <stdint.h>
#include <string.h>

#define SLC_HALF_MAX 65504.0f

static inline uint32_t slc_float_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline float slc_float_from_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/** Exact for every half; infinities stay infinite, a NaN keeps its sign and payload. */
static inline float slc_float_from_half(uint16_t half)
{
    uint32_t sign = (uint32_t)(half & 0x8000u) << 16;
    uint32_t magnitude = half & 0x7FFFu;
    if (magnitude >= 0x7C00)
        return slc_float_from_bits(sign | 0x7F800000u | (magnitude & 0x3FFu) << 13);
    /* The exponent is off by 112; scaling sets that right for denormals, too, and is exact. */
    float scaled = slc_float_from_bits(magnitude << 13) * 0x1p112f;
    return slc_float_from_bits(slc_float_bits(scaled) | sign);
}

/** Nearest half, ties to even; beyond +-65504, infinities included, +-65504; NaN becomes 0. */
static inline uint16_t slc_half_from_float(float value)
{
    uint32_t bits = slc_float_bits(value);
    uint16_t sign = (uint16_t)(bits >> 16 & 0x8000u);
    uint32_t magnitude = bits & 0x7FFFFFFFu;
    if (magnitude > 0x7F800000u)
        return 0;
    if (magnitude >= 0x477FE000u) /* 65504 */
        return sign | 0x7BFF;
    if (magnitude <
        0x38800000u) { /* below 2^-14: a multiple of 2^-24, which the addition rounds to */
        float shifted = slc_float_from_bits(magnitude) + 0.5f;
        return (uint16_t)(sign | (slc_float_bits(shifted) - 0x3F000000u));
    }
    uint32_t odd = magnitude >> 13 & 1;
    return (uint16_t)(sign | (magnitude - 0x38000000u + 0xFFF + odd) >> 13);
}

#endif /* SLC_IMAGE_HALF_H */
