/*
 * Computes the inputs of the network of a neural texture for one texel, in integers: features of latents,
 * position and level. Only neural.glsl includes this file. docs/neural.md has the rules.
 */
#ifndef SLUICE_NEURAL_INPUTS_GLSL
#define SLUICE_NEURAL_INPUTS_GLSL

#include "language.glsl"
#include "shared/neural.h"

/* Inputs of the widest network, four in a word. */
#define SLUICE_NEURAL_WORDS 24
#define SLUICE_NEURAL_CHANNELS 16

#ifdef SLUICE_NEURAL_SCHEMA
#define SLUICE_NEURAL_IS_SCHEMA_1(s) (SLUICE_NEURAL_SCHEMA == 1)
#else
#define SLUICE_NEURAL_IS_SCHEMA_1(s) (SLUICE_NEURAL_CONSTANTS(s).schema == 1u)
#endif
#ifdef SLUICE_NEURAL_INPUTS
#define SLUICE_NEURAL_INPUT_COUNT(s) uint(SLUICE_NEURAL_INPUTS)
#else
#define SLUICE_NEURAL_INPUT_COUNT(s) SLUICE_NEURAL_CONSTANTS(s).inputCount
#endif

/** Four texels of a slice around a place, and their weights. */
struct SluiceNeuralCorners {
    uint first;    /* word of the latents where the slice begins */
    uvec4 texels;  /* numbers in the slice: (x0, y0), (x1, y0), (x0, y1), (x1, y1) */
    uvec4 weights; /* in units of 1 / 65536 */
};

/** Returns 256 times the place of a texel of a mip of `size` texels in a grid, from its first texel's center. */
int sluiceNeuralPlace(uint x, uint grid, uint size)
{
    uint a = (2u * x + 1u) * grid, b = 2u * size;
    return int(a / b * 256u + a % b * 256u / b) - 128;
}

/** Returns the texels of a slice for corner and corner + 1 along an axis. Beyond the slice: -1. */
ivec2 sluiceNeuralFit(int corner, int grid, int origin, int size, bool clamps)
{
    ivec2 at = ivec2(corner, corner + 1);
    if (clamps) {
        at = clamp(at, SLUICE_SPLAT(ivec2, 0), SLUICE_SPLAT(ivec2, grid - 1)) - origin;
    } else {
        at += ivec2(lessThan(at, SLUICE_SPLAT(ivec2, 0))) * grid;
        at -= ivec2(greaterThanEqual(at, SLUICE_SPLAT(ivec2, grid))) * grid + origin;
        at += ivec2(lessThan(at, SLUICE_SPLAT(ivec2, 0))) * grid;
    }
    return ivec2(at.x >= 0 && at.x < size ? at.x : -1, at.y >= 0 && at.y < size ? at.y : -1);
}

/** Finds the corners of a texel. False if the slice does not have them. */
bool sluiceNeuralFindCorners(uint s, uint slice, uvec2 texel, uvec2 mipSize, out SluiceNeuralCorners c)
{
    uint gridSize = SLUICE_NEURAL_CONSTANTS(s).slices[slice].gridSize;
    uint origin = SLUICE_NEURAL_CONSTANTS(s).slices[slice].origin;
    uint sliceSize = SLUICE_NEURAL_CONSTANTS(s).slices[slice].sliceSize;
    bool clamps = SLUICE_NEURAL_IS_SCHEMA_1(s);
    int placeX = sluiceNeuralPlace(texel.x, gridSize & 0xFFFFu, mipSize.x);
    int placeY = sluiceNeuralPlace(texel.y, gridSize >> 16u, mipSize.y);
    ivec2 x = sluiceNeuralFit(placeX >> 8, int(gridSize & 0xFFFFu), int(origin & 0xFFFFu),
                              int(sliceSize & 0xFFFFu), clamps);
    ivec2 y = sluiceNeuralFit(placeY >> 8, int(gridSize >> 16u), int(origin >> 16u), int(sliceSize >> 16u), clamps);
    uvec2 wx = uvec2(256 - (placeX & 255), placeX & 255), wy = uvec2(256 - (placeY & 255), placeY & 255);
    c.first = SLUICE_NEURAL_CONSTANTS(s).slices[slice].dataOffset / 4u;
    c.texels = uvec4(y.xxyy) * (sliceSize & 0xFFFFu) + uvec4(x.xyxy);
    c.weights = wx.xyxy * wy.xxyy;
    return min(min(x.x, x.y), min(y.x, y.y)) >= 0;
}

/** Returns the codes of four features of a texel, from the lowest bits on. They lie in one word. */
uint sluiceNeuralCodes(uint s, uint first, uint texel, uint features, uint bits, uint group)
{
    uint bit = (texel * features + 4u * group) * bits;
    return SLUICE_NEURAL_LATENT_WORD(s, first + bit / 32u) >> (bit & 31u);
}

uvec4 sluiceNeuralUnpack(uint codes, uint bits)
{
    return (SLUICE_SPLAT(uvec4, codes) >> (uvec4(0u, 1u, 2u, 3u) * bits)) & ((1u << bits) - 1u);
}

/** Returns the values of codes of schema 1, in units of 1 / 127.5. */
ivec4 sluiceNeuralValues(uint codes, uint bits)
{
    ivec4 c = ivec4(sluiceNeuralUnpack(codes, bits));
    if (bits == 4u)
        return 15 * c - 105;
    return bits == 1u ? 85 * c : bits == 2u ? 51 * c - 51 : c - 126;
}

uint sluiceNeuralPack(ivec4 v)
{
    uvec4 bytes = uvec4(v) & 0xFFu;
    return bytes.x | bytes.y << 8u | bytes.z << 16u | bytes.w << 24u;
}

/** Returns four values of a wave of the position, as bytes. */
uint sluiceNeuralWave(uint s, vec2 position, float scale, bool isSchema1)
{
    precise vec4 t = position.xyxy * scale + vec4(0.0, 0.0, 0.25, 0.25);
    precise vec4 part = t - floor(t);
    precise vec4 code;
    if (isSchema1) {
        code = (abs(4.0 * part - 2.0) - 1.0) * 127.5;
        code = clamp(code, -128.0, 127.0);
    } else {
        code = floor((2.0 * part - 1.0) * 127.5 - 0.5);
        code = clamp(code, -127.0, 127.0);
    }
    return sluiceNeuralPack(ivec4(code));
}

/** Writes the inputs of position and level, from word `at` on. */
void sluiceNeuralTail(uint s, uvec2 texel, uint mip, uint at, inout uint inputs[SLUICE_NEURAL_WORDS])
{
    bool isSchema1 = SLUICE_NEURAL_IS_SCHEMA_1(s);
    precise vec2 position = vec2(texel) * SLUICE_NEURAL_CONSTANTS(s).mips[mip].positionScale;
    float first = isSchema1 ? 0.125 : 1.0;
    inputs[at] = sluiceNeuralWave(s, position, first, isSchema1);
    inputs[at + 1u] = sluiceNeuralWave(s, position, 2.0 * first, isSchema1);
    inputs[at + 2u] = sluiceNeuralWave(s, position, 4.0 * first, isSchema1);
    inputs[at + 3u] = (uint(SLUICE_NEURAL_CONSTANTS(s).mips[mip].lodCode) & 0xFFu) * 0x101u;
}

/** Schema 3: the mean of four texels of two latent images. */
bool sluiceNeuralInputs3(uint s, uvec2 texel, uint mip, uvec2 mipSize, out uint inputs[SLUICE_NEURAL_WORDS])
{
    uint slice = SLUICE_NEURAL_CONSTANTS(s).mips[mip].firstSlice;
    uint features = SLUICE_NEURAL_CONSTANTS(s).highFeatures;
    bool resident = true;
    for (uint image = 0u; image < 2u; image++) {
        SluiceNeuralCorners c;
        resident = sluiceNeuralFindCorners(s, slice + image, texel, mipSize, c) && resident;
        if (!resident)
            return false;
        for (uint group = 0u; group < 4u; group++) {
            uvec4 sum = SLUICE_SPLAT(uvec4, 0u);
            for (uint i = 0u; i < 4u && 4u * group < features; i++)
                sum += c.weights[i] *
                       sluiceNeuralUnpack(sluiceNeuralCodes(s, c.first, c.texels[i], features, 4u, group), 4u);
            inputs[4u * image + group] =
                4u * group < features ? sluiceNeuralPack(ivec4(17u * sum >> 16u) - 128) : 0u;
        }
    }
    sluiceNeuralTail(s, texel, mip, 8u, inputs);
    return true;
}

/** Schema 1: four weighted texels of the fine grid, and the mean of four texels of the coarse grid. */
bool sluiceNeuralInputs1(uint s, uvec2 texel, uint mip, uvec2 mipSize, out uint inputs[SLUICE_NEURAL_WORDS])
{
    uint slice = SLUICE_NEURAL_CONSTANTS(s).mips[mip].firstSlice;
    uint words = (SLUICE_NEURAL_INPUT_COUNT(s) - 32u) / 16u; /* words of one corner */
    uint features = SLUICE_NEURAL_CONSTANTS(s).highFeatures, bits = SLUICE_NEURAL_CONSTANTS(s).highBits;
    SluiceNeuralCorners c;
    if (!sluiceNeuralFindCorners(s, slice, texel, mipSize, c))
        return false;
    for (uint i = 0u; i < 4u; i++)
        for (uint group = 0u; group < words; group++) {
            uint word = 0u;
            if (4u * group < features) {
                uint codes = sluiceNeuralCodes(s, c.first, c.texels[i], features, bits, group);
                word = sluiceNeuralPack(sluiceNeuralValues(codes, bits) * int(c.weights[i] >> 8u) >> 8);
            }
            inputs[i * words + group] = word;
        }
    if (!sluiceNeuralFindCorners(s, slice + 1u, texel, mipSize, c))
        return false;
    features = SLUICE_NEURAL_CONSTANTS(s).lowFeatures;
    bits = SLUICE_NEURAL_CONSTANTS(s).lowBits;
    for (uint group = 0u; group < 4u; group++) {
        ivec4 sum = SLUICE_SPLAT(ivec4, 0);
        for (uint i = 0u; i < 4u && 4u * group < features; i++)
            sum += sluiceNeuralValues(sluiceNeuralCodes(s, c.first, c.texels[i], features, bits, group), bits) *
                   int(c.weights[i] >> 8u);
        inputs[4u * words + group] = sluiceNeuralPack(sum >> 8);
    }
    sluiceNeuralTail(s, texel, mip, 4u * words + 4u, inputs);
    return true;
}

/** Computes the inputs of a texel, four in a word. False if the slices do not have its latents. */
bool sluiceNeuralInputs(uint s, uvec2 texel, uint mip, uvec2 mipSize, out uint inputs[SLUICE_NEURAL_WORDS])
{
    if (SLUICE_NEURAL_IS_SCHEMA_1(s))
        return sluiceNeuralInputs1(s, texel, mip, mipSize, inputs);
    return sluiceNeuralInputs3(s, texel, mip, mipSize, inputs);
}

#endif
