/*
 * Chooses one texel of one level at random, so that the mean of many samples is the filtered texture:
 *
 *     vec2 random = sluiceRandomPair(uvec3(pixel, frame));
 *     SluicePick pick = sluicePickTexel(uv, lod, size, levelCount, modes, SLUICE_PICK_LINEAR, 0.0, random);
 *     vec4 color = pick.border ? borderColor : texelFetch(tex, pick.texel, int(pick.level));
 *
 * For textures that are costly to decode per texel, and for filters that samplers lack. Streamed
 * textures: sample_stochastic.glsl.
 *
 *     filter    probability of a texel, along each axis                    mean of many samples
 *     POINT     1 for the nearest                                          nearest texel
 *     LINEAR    tent, 2 texels wide                                        linear filter
 *     CUBIC     cubic B-spline, 4 texels wide                              bicubic filter (cubic.glsl)
 *     GAUSSIAN  Gaussian of deviation `sigma` in texels of the chosen      box of 1 texel * Gaussian
 *               level, integrated over the texel. sigma 0: POINT
 *
 * The fraction of the LOD is the probability of the coarser level. So a LOD between two levels gives the
 * trilinear filter.
 *
 * `random` is from the application: two independent numbers, uniform in 0 to 1, 1 excluded, with at
 * least 16 bits each. Blue noise of 8 bits needs more bits: add a hash in units of its last bit. A
 * number is used again after each decision: the share that lies on the chosen side is stretched to 0 to
 * 1. So the numbers that are returned may serve another decision, except after GAUSSIAN. The choice
 * rises with the number, so numbers that are spread evenly stay so.
 *
 * Functions need nothing that is defined before.
 *
 * Source: Fajardo et al., "Stochastic Texture Filtering", 2023.
 */
#ifndef SLUICE_STOCHASTIC_FILTER_GLSL
#define SLUICE_STOCHASTIC_FILTER_GLSL

#include "cubic.glsl"
#include "lod.glsl"
#include "stochastic.glsl"

#define SLUICE_PICK_POINT 0u
#define SLUICE_PICK_LINEAR 1u
#define SLUICE_PICK_CUBIC 2u
#define SLUICE_PICK_GAUSSIAN 3u

/* The largest float below 1. */
#define SLUICE_RANDOM_LAST 0.99999994
/* Largest deviation of GAUSSIAN. */
#define SLUICE_PICK_MAX_SIGMA 65536.0
/* Texels from 0 where coordinates are clamped. Beyond, floats have no fractions. */
#define SLUICE_PICK_MAX_TEXEL 8388608.0

/** A chosen texel. */
struct SluicePick {
    ivec2 texel; /* inside the level, also with `border` */
    uint level;
    bool border; /* the texel has the border color (CLAMP_TO_BORDER) */
};

/** Returns two random numbers of a hash: uniform in 0 to 1, 1 excluded, multiples of 2^-24. */
vec2 sluiceRandomPair(uvec3 v)
{
    uint first = sluiceHash(v), second = sluiceHash(uvec3(first, v.x + 0x68E31DA4u, v.y ^ v.z));
    return vec2(first >> 8u, second >> 8u) * (1.0 / 16777216.0);
}

/** Returns a number that lies `offset` into a share of 0 to 1, stretched to 0 to 1. */
float sluiceStretchRandom(float offset, float share)
{
    return clamp(offset / share, 0.0, SLUICE_RANDOM_LAST);
}

/** Returns true with the given probability, 0 to 1. `random` may be used again. */
bool sluiceDecide(float probability, inout float random)
{
    bool yes = random >= 1.0 - probability;
    if (yes)
        random = sluiceStretchRandom(random - (1.0 - probability), probability);
    else
        random = sluiceStretchRandom(random, 1.0 - probability);
    return yes;
}

/** Returns the chosen one of `count` levels. NaN is the coarsest. */
uint sluicePickLevel(float lod, uint count, inout float random)
{
    lod = clamp(sluiceClampLod(lod), 0.0, float(count - 1u));
    float fine = floor(lod);
    return uint(fine) + (sluiceDecide(lod - fine, random) ? 1u : 0u);
}

/** Returns the place of a texel in weights `w` of four neighbors that sum to 1. */
int sluicePickWeight(vec4 w, inout float random)
{
    float before = 0.0;
    for (int i = 0; i < 3; i++) {
        if (random < before + w[i]) {
            random = sluiceStretchRandom(random - before, w[i]);
            return i;
        }
        before += w[i];
    }
    random = sluiceStretchRandom(random - before, 1.0 - before);
    return 3;
}

/** Returns the chosen texel along an axis; it may lie outside. `at` is in texels. Not for GAUSSIAN. */
int sluicePickAlong(float at, uint kernel, inout float random)
{
    if (kernel == SLUICE_PICK_POINT)
        return int(floor(at));
    at -= 0.5;
    float low = floor(at);
    if (kernel == SLUICE_PICK_LINEAR)
        return int(low) + (sluiceDecide(at - low, random) ? 1 : 0);
    return int(low) - 1 + sluicePickWeight(sluiceSplineWeights(at - low), random);
}

/** Returns two independent numbers of the normal distribution. Finite for all of 0 to 1. */
vec2 sluiceNormalPair(vec2 random)
{
    float radius = sqrt(-2.0 * log(max(1.0 - random.x, 5.9604645e-8)));
    float angle = 6.28318531 * (random.y - 0.5); /* devices are exact from -pi to pi */
    return radius * vec2(cos(angle), sin(angle));
}

/**
 * Returns where a coordinate lies, in texels of a level of `n` texels, near the image: repetitions are
 * taken off before digits are lost.
 */
float sluicePlaceTexel(float coordinate, uint addressMode, float n)
{
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT)
        coordinate -= floor(coordinate);
    else if (addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT)
        coordinate -= 2.0 * floor(coordinate * 0.5);
    return clamp(coordinate * n, -SLUICE_PICK_MAX_TEXEL, SLUICE_PICK_MAX_TEXEL);
}

int sluiceWrapTexel(int i, int n)
{
    return i >= 0 ? i % n : n - 1 - (-1 - i) % n;
}

/** Returns the texel inside an axis of `n` texels that an address mode shows for texel `i`. */
int sluiceAddressTexel(int i, uint addressMode, int n)
{
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT)
        return sluiceWrapTexel(i, n);
    if (addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
        i = sluiceWrapTexel(i, 2 * n);
        return i < n ? i : 2 * n - 1 - i;
    }
    if (addressMode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE && i < 0)
        i = -1 - i;
    return clamp(i, 0, n - 1);
}

/** Returns the pick that the address modes show for a texel that may lie outside. */
SluicePick sluiceAddressPick(ivec2 texel, uint level, ivec2 n, uvec2 addressModes)
{
    ivec2 inside = ivec2(sluiceAddressTexel(texel.x, addressModes.x, n.x),
                         sluiceAddressTexel(texel.y, addressModes.y, n.y));
    bool x = addressModes.x == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER && texel.x != inside.x;
    bool y = addressModes.y == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER && texel.y != inside.y;
    SluicePick pick;
    pick.texel = inside;
    pick.level = level;
    pick.border = x || y;
    return pick;
}

/** Returns the size of a level. `size` is that of level 0. */
ivec2 sluicePickSize(uvec2 size, uint level)
{
    return ivec2(max(size >> level, SLUICE_SPLAT(uvec2, 1u)));
}

/** Chooses a texel of a level. Arguments are those of sluicePickTexel. */
SluicePick sluicePickInLevel(vec2 uv, uint level, uvec2 size, uvec2 addressModes, uint kernel, float sigma,
                             inout vec2 random)
{
    ivec2 n = sluicePickSize(size, level);
    if (!sluiceIsFinite(uv))
        uv = SLUICE_SPLAT(vec2, 0.0);
    vec2 at = vec2(sluicePlaceTexel(uv.x, addressModes.x, float(n.x)),
                   sluicePlaceTexel(uv.y, addressModes.y, float(n.y)));
    random = clamp(random, 0.0, SLUICE_RANDOM_LAST);
    if (kernel == SLUICE_PICK_GAUSSIAN) {
        if (sigma > 0.0)
            at += min(sigma, SLUICE_PICK_MAX_SIGMA) * sluiceNormalPair(random);
        kernel = SLUICE_PICK_POINT;
    }
    ivec2 texel = ivec2(sluicePickAlong(at.x, kernel, random.x), sluicePickAlong(at.y, kernel, random.y));
    return sluiceAddressPick(texel, level, n, addressModes);
}

/**
 * Chooses a texel. `lod` is computed by the application: sluiceComputeLod, or that of a ray. `size` is
 * that of level 0; level l has max(1, size >> l) texels. `addressModes` are SLUICE_ADDRESS_MODE_*. If
 * `uv` is not finite, it counts as 0; a LOD of NaN counts as that of the coarsest level.
 */
SluicePick sluicePickTexel(vec2 uv, float lod, uvec2 size, uint levelCount, uvec2 addressModes, uint kernel,
                           float sigma, inout vec2 random)
{
    random = clamp(random, 0.0, SLUICE_RANDOM_LAST);
    uint level = sluicePickLevel(lod, levelCount, random.x);
    return sluicePickInLevel(uv, level, size, addressModes, kernel, sigma, random);
}

#endif
