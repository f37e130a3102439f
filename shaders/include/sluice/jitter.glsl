/*
 * Moves a sample by a random offset, so that the mean of many samples of one tap is a wider filter:
 *
 *     vec2 at = sluiceJitter(uv, dx, dy, 0.0, 1.0, size, SLUICE_JITTER_TENT, random);
 *     vec4 color = sluiceSampleGrad(tex, tableIndex, at, dx, dy, 0.0, 1.0, missing);
 *
 * Pass the same derivatives, LOD bias and anisotropy to the sample. Any function that takes `uv` and
 * derivatives will do, also textureGrad. For demand loading: demand_jitter.glsl.
 *
 * `random` is from the application: two independent numbers, uniform in -1/2 to 1/2. 0 is the center:
 * no offset. Use a sequence that is spread evenly over the samples of a pixel, and the same numbers
 * when a ray is traced again because something was missing.
 *
 * The mean is the filter of the tap, convolved with the density of the offset:
 *
 *     kernel    density of the offset, per axis               nearest tap          linear tap
 *     BOX       uniform, 1 texel wide                         linear filter        quadratic B-spline
 *     TENT      triangle, 2 texels wide                       quadratic B-spline   cubic B-spline (cubic.glsl)
 *     GAUSSIAN  Gaussian, deviation 1/2 texel, cut off at     1-texel box *        linear filter * Gaussian
 *               1 1/4 texels                                  Gaussian
 *
 * A texel here is one of the sample's LOD: 2 to the power of the LOD, but at least 1, in texels of level
 * 0. At a whole LOD the table is exact. Between two levels both have the same offset, of the texel of
 * the LOD. A coarser level that stands in for a missing one gets the offset of the LOD that is wanted.
 *
 * Functions need nothing that is defined before. Feedback of streamed textures: feedback_jitter.glsl.
 */
#ifndef SLUICE_JITTER_GLSL
#define SLUICE_JITTER_GLSL

#include "lod.glsl"

#define SLUICE_JITTER_BOX 0u
#define SLUICE_JITTER_TENT 1u
#define SLUICE_JITTER_GAUSSIAN 2u

/* Standard deviation of GAUSSIAN, in texels. */
#define SLUICE_JITTER_DEVIATION 0.5
/* Share of the Gaussian within 2.5 deviations. */
#define SLUICE_JITTER_GAUSSIAN_SHARE 0.98758067

/** Returns the largest offset of a kernel, in texels, along either axis. */
float sluiceJitterReach(uint kernel)
{
    if (kernel == SLUICE_JITTER_GAUSSIAN)
        return 2.5 * SLUICE_JITTER_DEVIATION;
    return kernel == SLUICE_JITTER_TENT ? 1.0 : 0.5;
}

/**
 * Returns the inverse of the error function, for -0.9966 to 0.9966. Relative error: 1e-6.
 *
 * Source: Giles, "Approximating the erfinv Function", GPU Computing Gems, Jade Edition, 2011.
 */
vec2 sluiceInverseErf(vec2 x)
{
    vec2 w = -log((1.0 - x) * (1.0 + x)) - 2.5;
    vec2 p = 3.43273939e-07 + 2.81022636e-08 * w;
    p = -3.5233877e-06 + p * w;
    p = -4.39150654e-06 + p * w;
    p = 0.00021858087 + p * w;
    p = -0.00125372503 + p * w;
    p = -0.00417768164 + p * w;
    p = 0.246640727 + p * w;
    p = 1.50140941 + p * w;
    return p * x;
}

/** Returns the offset of a kernel in texels: the inverse of its distribution. */
vec2 sluiceJitterOffset(uint kernel, vec2 random)
{
    random = clamp(random, -0.5, 0.5);
    if (kernel == SLUICE_JITTER_TENT)
        return sign(random) * (1.0 - sqrt(1.0 - 2.0 * abs(random)));
    if (kernel == SLUICE_JITTER_GAUSSIAN)
        return SLUICE_JITTER_DEVIATION * sqrt(2.0) *
               sluiceInverseErf(2.0 * SLUICE_JITTER_GAUSSIAN_SHARE * random);
    return random;
}

/** Returns the width of a texel of a LOD, bias included, in texels of level 0, which has `size`. */
float sluiceJitterTexel(float lod, vec2 size)
{
    return clamp(exp2(lod), 1.0, max(size.x, size.y));
}

/**
 * Returns the position to sample instead of `uv`. `dx` and `dy`: derivatives of `uv` per pixel.
 * `lodBias` and `maxAnisotropy` (1: none): of the sample. `size`: texels of level 0.
 */
vec2 sluiceJitter(vec2 uv, vec2 dx, vec2 dy, float lodBias, float maxAnisotropy, vec2 size, uint kernel,
                  vec2 random)
{
    float lod = sluiceComputeLod(dx * size, dy * size, lodBias, maxAnisotropy);
    return uv + sluiceJitterTexel(lod, size) * sluiceJitterOffset(kernel, random) / size;
}

#endif
