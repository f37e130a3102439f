/* Buffers and push constants of the passes that train a set. lib/neural_train/layout.h is the twin. */
#ifndef TRAIN_LAYOUT_GLSL
#define TRAIN_LAYOUT_GLSL

#include "train_layout.h"

layout(constant_id = 0) const uint FEATURE_COUNT = 16; /* features of a latent image: 4, 8, 12 or 16 */
layout(constant_id = 1) const uint REFERENCE_WORDS = 8; /* words of a texel: two channels each */

layout(push_constant) uniform Push
{
    TRAIN_PUSH_FIELDS
} push;

bool has_flag(uint flag)
{
    return (push.flags & flag) != 0u;
}

/* PCG of Jarzynski and Olano, "Hash Functions for GPU Rendering" (2020). */
uint hash(uint x)
{
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
    return (x >> 22) ^ x;
}

uint hash3(uint a, uint b, uint c)
{
    return hash(a + hash(b + hash(c)));
}

float unit_float(uint bits)
{
    return float(bits >> 8) * (1.0 / 16777216.0);
}

/* The nearest E4M3 numbers, as floats: 3 bits of mantissa, smallest step 2^-9, largest value 448. */
vec4 round_to_e4m3(vec4 x)
{
    vec4 size = min(abs(x), vec4(448.0));
    uvec4 exponent = max(floatBitsToUint(size) >> 23, uvec4(127u - 6u));
    vec4 unit = uintBitsToFloat((exponent - 3u) << 23);
    return sign(x) * roundEven(size / unit) * unit;
}

#endif
