/*
 * Which pixels write feedback in a frame: few, so that it costs little, but all in turn.
 *
 * Integer only, so that every device selects the same pixels. C twin: lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_STOCHASTIC_GLSL
#define SLUICE_STOCHASTIC_GLSL

/** Mixes all bits of three words. Every pixel pays for it, so it is short. */
uint sluiceHash(uvec3 v)
{
    uint h = (v.x * 0x9E3779B1u) ^ (v.y * 0x85EBCA77u) ^ (v.z * 0xC2B2AE3Du);
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12u)) * 0x297A2D39u;
    return h ^ (h >> 15u);
}

/**
 * One decision for the four pixels of a 2x2 quad, true with the given probability; independent
 * between quads and between seeds. 1 and more is always true, 0, less and NaN never.
 */
bool sluiceSelectRandomQuad(uvec2 pixel, uint frameSeed, float probability)
{
    if (probability >= 1.0)
        return true;
    float draw = float(sluiceHash(uvec3(pixel >> 1u, frameSeed)) >> 8u) * (1.0 / 16777216.0);
    return draw < probability;
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
    return (pixel.x & 7u) == (x ^ y) && (pixel.y & 7u) == y;
}

#endif
