/*
 * Inputs, rounding and activation of networks whose layers 0 to 2 are floating point, as sluiceDecodeNeuralTexels
 * has them for FP8 weights. Only neural.glsl includes this file. docs/neural.md has the rules.
 */
#ifndef SLUICE_NEURAL_VALUES_GLSL
#define SLUICE_NEURAL_VALUES_GLSL

#include "neural_inputs.glsl"

#define SLUICE_NEURAL_VALUES 96

/** Returns the weighted sums of four features of four texels: codes of schema 3, values of schema 1. */
ivec4 sluiceNeuralSums(uint s, SluiceNeuralCorners c, uvec4 weights, uint features, uint bits, uint group)
{
    ivec4 sums = ivec4(0);
    for (uint i = 0u; i < 4u; i++) {
        uint codes = sluiceNeuralCodes(s, c.first, c.texels[i], features, bits, group);
        ivec4 values = SLUICE_NEURAL_IS_SCHEMA_1(s) ? sluiceNeuralValues(codes, bits)
                                                    : ivec4(sluiceNeuralUnpack(codes, 4u));
        sums += values * int(weights[i]);
    }
    return sums;
}

/** Writes four inputs: sums times a unit, plus an offset. */
void sluiceNeuralPutValues(ivec4 sums, float unit, float offset, uint at, inout float inputs[SLUICE_NEURAL_VALUES])
{
    precise vec4 values = vec4(sums) * unit;
    values = values + offset;
    for (uint i = 0u; i < 4u; i++)
        inputs[at + i] = values[i];
}

/** Writes position and level from input `at` on. */
void sluiceNeuralTailValues(uint s, uvec2 texel, uint mip, uint at, inout float inputs[SLUICE_NEURAL_VALUES])
{
    bool isSchema1 = SLUICE_NEURAL_IS_SCHEMA_1(s);
    precise vec2 position = vec2(texel) * SLUICE_NEURAL_CONSTANTS(s).mips[mip].positionScale;
    for (uint i = 0u; i < 12u; i++) {
        precise float t = position[i & 1u] * ((isSchema1 ? 0.125 : 1.0) * float(1u << i / 4u));
        t = t + ((i & 2u) != 0u ? 0.25 : 0.0);
        precise float part = t - floor(t);
        precise float wave = isSchema1 ? abs(4.0 * part - 2.0) - 1.0 : 2.0 * part - 1.0;
        inputs[at + i] = wave;
    }
    inputs[at + 12u] = inputs[at + 13u] = SLUICE_NEURAL_CONSTANTS(s).mips[mip].positionLod;
}

/** Schema 3: the mean of four texels of two latent images. */
bool sluiceNeuralValues3(uint s, uvec2 texel, uint mip, uvec2 mipSize, inout float inputs[SLUICE_NEURAL_VALUES])
{
    uint slice = SLUICE_NEURAL_CONSTANTS(s).mips[mip].firstSlice;
    uint features = SLUICE_NEURAL_CONSTANTS(s).highFeatures;
    for (uint image = 0u; image < 2u; image++) {
        SluiceNeuralCorners c;
        if (!sluiceNeuralFindCorners(s, slice + image, texel, mipSize, c))
            return false;
        for (uint group = 0u; group < 4u; group++)
            if (4u * group < features)
                sluiceNeuralPutValues(sluiceNeuralSums(s, c, c.weights, features, 4u, group), 2.0 / (15.0 * 65536.0),
                                      -1.0, 16u * image + 4u * group, inputs);
    }
    sluiceNeuralTailValues(s, texel, mip, 32u, inputs);
    return true;
}

/** Schema 1: four weighted texels of the fine grid, and the mean of four texels of the coarse grid. */
bool sluiceNeuralValues1(uint s, uvec2 texel, uint mip, uvec2 mipSize, inout float inputs[SLUICE_NEURAL_VALUES])
{
    const float unit = 1.0 / (127.5 * 65536.0);
    uint slice = SLUICE_NEURAL_CONSTANTS(s).mips[mip].firstSlice;
    uint corner = (SLUICE_NEURAL_INPUT_COUNT(s) - 32u) / 4u; /* inputs of one */
    uint features = SLUICE_NEURAL_CONSTANTS(s).highFeatures, bits = SLUICE_NEURAL_CONSTANTS(s).highBits;
    SluiceNeuralCorners c;
    if (!sluiceNeuralFindCorners(s, slice, texel, mipSize, c))
        return false;
    for (uint i = 0u; i < 4u; i++)
        for (uint group = 0u; group < 4u; group++)
            if (4u * group < features) {
                uint codes = sluiceNeuralCodes(s, c.first, c.texels[i], features, bits, group);
                sluiceNeuralPutValues(sluiceNeuralValues(codes, bits) * int(c.weights[i]), unit, 0.0,
                                      i * corner + 4u * group, inputs);
            }
    if (!sluiceNeuralFindCorners(s, slice + 1u, texel, mipSize, c))
        return false;
    features = SLUICE_NEURAL_CONSTANTS(s).lowFeatures;
    bits = SLUICE_NEURAL_CONSTANTS(s).lowBits;
    for (uint group = 0u; group < 4u; group++)
        if (4u * group < features)
            sluiceNeuralPutValues(sluiceNeuralSums(s, c, c.weights, features, bits, group), unit, 0.0,
                                  4u * corner + 4u * group, inputs);
    sluiceNeuralTailValues(s, texel, mip, 4u * corner + 16u, inputs);
    return true;
}

/** Computes the inputs of a texel, not rounded. False if the slices do not have its latents. */
bool sluiceNeuralInputValues(uint s, uvec2 texel, uint mip, uvec2 mipSize, out float inputs[SLUICE_NEURAL_VALUES])
{
    for (uint i = 0u; i < SLUICE_NEURAL_VALUES; i++)
        inputs[i] = 0.0;
    if (SLUICE_NEURAL_IS_SCHEMA_1(s))
        return sluiceNeuralValues1(s, texel, mip, mipSize, inputs);
    return sluiceNeuralValues3(s, texel, mip, mipSize, inputs);
}

/** Rounds to half, as inputs are before they become E4M3. Values below 2^-14 are no matter there. */
float sluiceNeuralRoundHalf(float value)
{
    uint bits = floatBitsToUint(value);
    return uintBitsToFloat((bits + 0xFFFu + (bits >> 13u & 1u)) & ~0x1FFFu);
}

/** Rounds to the nearest number of E4M3, ties to even, at most 448. */
float sluiceNeuralRoundE4M3(float value)
{
    uint bits = floatBitsToUint(value), sign = bits & 0x80000000u;
    precise float magnitude = uintBitsToFloat(bits ^ sign);
    if (!(magnitude < 448.0))
        magnitude = 448.0;
    else if (magnitude < 0.015625) /* a multiple of 2^-9, to which the addition rounds */
        magnitude = (magnitude + 16384.0) - 16384.0;
    else
        magnitude = uintBitsToFloat(((bits ^ sign) + 0x7FFFFu + (bits >> 20u & 1u)) & 0xFFF00000u);
    return uintBitsToFloat(floatBitsToUint(magnitude) | sign);
}

/** Returns the activation of a sum: a cubic GELU, clamped to 3. */
float sluiceNeuralActivation(float r)
{
    precise float t = clamp(r * 0.333333 + 0.5, 0.0, 1.0);
    precise float y = min(r, 3.0) * t;
    return y;
}

/** Returns an activation as a byte, in steps of 1/80. */
uint sluiceNeuralActivationCode(float y)
{
    precise float steps = y * 80.0;
    return uint(int(roundEven(steps)) - 113) & 0xFFu;
}

#endif
