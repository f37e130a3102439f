/*
 * Jitters samples of textures that are loaded on demand: jitter.glsl, with the size, anisotropy and LOD
 * biases of the texture.
 *
 *     vec2 at = sluiceDemandJitter(index, uv, dx, dy, SLUICE_JITTER_TENT, random);
 *     vec4 color = sluiceDemandGrad(index, at, dx, dy, resident);
 *
 * Include it after the definitions of demand.glsl, which it includes.
 */
#ifndef SLUICE_DEMAND_JITTER_GLSL
#define SLUICE_DEMAND_JITTER_GLSL

#include "demand.glsl"
#include "jitter.glsl"

/**
 * Returns where to take the sample instead of at `uv`. Textures that are not open, and grids, are
 * sampled at `uv`: jitter the texture of a cell by its own index.
 */
vec2 sluiceDemandJitter(uint index, vec2 uv, vec2 dx, vec2 dy, uint kernel, vec2 random)
{
    if (SLUICE_DEMAND_TEXTURE(index).state != SLUICE_DEMAND_TEXTURE_OPEN)
        return uv;
    vec2 size = vec2(SLUICE_DEMAND_TEXTURE(index).width, SLUICE_DEMAND_TEXTURE(index).height);
    float n = clamp(SLUICE_DEMAND_TEXTURE(index).maxAnisotropy, 1.0, SLUICE_DEMAND_MAX_ANISOTROPY);
    float lod = sluiceDemandComputeLod(dx * size, dy * size, n);
    lod += SLUICE_DEMAND_TEXTURE(index).lodBias + sluiceLoaderLodBias();
    return uv + sluiceJitterTexel(lod, size) * sluiceJitterOffset(kernel, random) / size;
}

#endif
