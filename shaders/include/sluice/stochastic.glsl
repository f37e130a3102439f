/*
 * Which pixels write feedback in a frame: few, so that it costs little, but all in turn.
 *
 * Integer only, so that every device selects the same pixels. C twin: lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_STOCHASTIC_GLSL
#define SLUICE_STOCHASTIC_GLSL

/** Mixes all bits of three words; a PCG-style permutation. */
uint sluiceHash(uvec3 v)
{
    uint h = v.x * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    h = (h >> 22u) ^ h;
    h = (h + v.y) * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    h = (h >> 22u) ^ h;
    h = (h + v.z) * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    return (h >> 22u) ^ h;
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
