/*
 * Selects the pixels that write feedback in a frame: few, so that feedback is cheap, and all in
 * turn.
 *
 * Integer arithmetic only, so every device selects the same pixels. C twin:
 * lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_STOCHASTIC_GLSL
#define SLUICE_STOCHASTIC_GLSL

#include "language.glsl"

/**
 * Mixes three words. The upper bits are better distributed. Every pixel runs it, so it is short.
 */
uint sluiceMix(uvec3 v)
{
    uint h = v.x * 0x9E3779B1u + v.y * 0x85EBCA77u + v.z * 0xC2B2AE3Du;
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    return (h ^ (h >> 13u)) * 0x297A2D39u;
}

/** Mixes three words. All bits are well distributed. */
uint sluiceHash(uvec3 v)
{
    uint h = sluiceMix(v);
    return h ^ (h >> 15u);
}

/* Bits of 2^23. An integer added to that float is in the lower bits of the sum. */
#define SLUICE_FLOAT_ORIGIN 0x4B000000u
/* 2^23, minus the half of a pixel center. */
#define SLUICE_PIXEL_ORIGIN 8388607.5

bool sluiceSelectRandom(uvec2 place, uint frameSeed, float probability)
{
    uint draw = sluiceMix(uvec3(place, frameSeed)) >> 9u;
    return uintBitsToFloat(draw | 0x3F800000u) - 1.0 < probability;
}

/**
 * Decides for the four pixels of a 2x2 quad together: true with the given probability. Decisions of
 * different quads and seeds are independent. A probability of 1 or more is always true; 0, negative
 * and NaN never.
 */
bool sluiceSelectRandomQuad(uvec2 pixel, uint frameSeed, float probability)
{
    return sluiceSelectRandom((pixel >> 1u) + SLUICE_FLOAT_ORIGIN, frameSeed, probability);
}

/**
 * Decides like sluiceSelectRandomQuad, for gl_FragCoord.xy (pixel centers below 2^22). Avoids the
 * slow conversion to integers. All pixels of a quad decide alike, so derivatives may be taken in
 * the branch.
 */
bool sluiceSelectRandomFragmentQuad(vec2 fragCoord, uint frameSeed, float probability)
{
    return sluiceSelectRandom(floatBitsToUint(fragCoord * 0.5 + SLUICE_PIXEL_ORIGIN), frameSeed,
                              probability);
}

/**
 * Selects one pixel in 8x8 on a lattice that moves each frame. Every pixel is selected exactly once
 * in any 64 consecutive frames. Pixels of consecutive frames are far apart.
 */
bool sluiceSelectLattice(uvec2 pixel, uint frameIndex)
{
    uint f = frameIndex & 63u;
    uint x = ((f & 1u) << 2u) | ((f & 4u) >> 1u) | ((f & 16u) >> 4u);
    uint y = ((f & 2u) << 1u) | ((f & 8u) >> 2u) | ((f & 32u) >> 5u);
    return (((pixel.x ^ x ^ y) | (pixel.y ^ y)) & 7u) == 0u;
}

/**
 * Returns the pixel of gl_FragCoord.xy without the slow conversion to integers. The bits from 23 on are
 * those of a float; the bits below are right. For sluiceSelectBlock and sluiceWriteQuadFeedback.
 */
uvec2 sluiceFragmentPixel(vec2 fragCoord)
{
    return floatBitsToUint(fragCoord + SLUICE_PIXEL_ORIGIN);
}

/**
 * Selects like sluiceSelectLattice, for gl_FragCoord.xy. Pixels of a quad decide differently: take
 * derivatives before the branch.
 */
bool sluiceSelectFragmentLattice(vec2 fragCoord, uint frameIndex)
{
    return sluiceSelectLattice(sluiceFragmentPixel(fragCoord), frameIndex);
}

/**
 * Selects one block of 4x4 pixels in 16x16 on a lattice that moves each frame. Every pixel is selected
 * exactly once in any 16 consecutive frames.
 *
 * Devices run fragment shaders in groups of 32 or 64 neighboring pixels, and a group waits for its pixels
 * that write. As many quads at random lie in three times as many groups. Blocks cost less, and meet every
 * pixel in time; most regions are met later than by random quads (docs/feedback.md).
 *
 * All pixels of a quad decide alike, so derivatives may be taken in the branch. With
 * sluiceWriteQuadFeedback pass `frameIndex >> 4` as frameSeed: with frameIndex a quad would mark the same
 * corners whenever it is selected. Count turns instead of frames if feedback is read back in turns.
 */
bool sluiceSelectBlock(uvec2 pixel, uint frameIndex)
{
    uint f = frameIndex;
    uint x = ((f & 1u) << 3u) | (f & 4u);
    uint y = ((f & 2u) << 2u) | ((f & 8u) >> 1u);
    return (((pixel.x ^ x ^ y) | (pixel.y ^ y)) & 12u) == 0u;
}

#endif
