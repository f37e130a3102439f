/*
 * Which pixels write feedback in a frame: few, so that it costs little, but all in turn.
 *
 * Integer only, so that every device selects the same pixels. C twin: lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_STOCHASTIC_GLSL
#define SLUICE_STOCHASTIC_GLSL

/** Mixes three words; the upper bits are the better ones. Every pixel pays for it, so it is short. */
uint sluiceMix(uvec3 v)
{
    uint h = v.x * 0x9E3779B1u + v.y * 0x85EBCA77u + v.z * 0xC2B2AE3Du;
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    return (h ^ (h >> 13u)) * 0x297A2D39u;
}

/** The same with good lower bits. */
uint sluiceHash(uvec3 v)
{
    uint h = sluiceMix(v);
    return h ^ (h >> 15u);
}

/* Bits of 2^23: whole numbers that are added to it are in the lower bits of the sum. */
#define SLUICE_FLOAT_ORIGIN 0x4B000000u
/* The same number, less the half of a pixel's centre. */
#define SLUICE_PIXEL_ORIGIN 8388607.5

bool sluiceSelectRandom(uvec2 place, uint frameSeed, float probability)
{
    uint draw = sluiceMix(uvec3(place, frameSeed)) >> 9u;
    return uintBitsToFloat(draw | 0x3F800000u) - 1.0 < probability;
}

/**
 * One decision for the four pixels of a 2x2 quad, true with the given probability; independent
 * between quads and between seeds. 1 and more is always true, 0, less and NaN never.
 */
bool sluiceSelectRandomQuad(uvec2 pixel, uint frameSeed, float probability)
{
    return sluiceSelectRandom((pixel >> 1u) + SLUICE_FLOAT_ORIGIN, frameSeed, probability);
}

/**
 * The same decision for gl_FragCoord.xy, the centre of a pixel below 2^22, without the conversion to
 * whole numbers, which is slow. As all of a quad decides alike, derivatives may be taken behind it.
 */
bool sluiceSelectRandomFragmentQuad(vec2 fragCoord, uint frameSeed, float probability)
{
    return sluiceSelectRandom(floatBitsToUint(fragCoord * 0.5 + SLUICE_PIXEL_ORIGIN), frameSeed,
                              probability);
}

/**
 * A lattice of one pixel in 8x8 that walks: every pixel is selected in exactly one of any 64
 * consecutive frames, and those of neighbouring frames lie far apart.
 */
bool sluiceSelectLattice(uvec2 pixel, uint frameIndex)
{
    uint f = frameIndex & 63u;
    uint x = ((f & 1u) << 2u) | ((f & 4u) >> 1u) | ((f & 16u) >> 4u);
    uint y = ((f & 2u) << 1u) | ((f & 8u) >> 2u) | ((f & 32u) >> 5u);
    return (((pixel.x ^ x ^ y) | (pixel.y ^ y)) & 7u) == 0u;
}

/** The same for gl_FragCoord.xy. Pixels of a quad do not decide alike: derivatives come before it. */
bool sluiceSelectFragmentLattice(vec2 fragCoord, uint frameIndex)
{
    return sluiceSelectLattice(floatBitsToUint(fragCoord + SLUICE_PIXEL_ORIGIN), frameIndex);
}

#endif
