/*
 * Samples streamed textures of integer formats (UINT, SINT), such as maps of identifiers: one texel of
 * one level, where it is resident, never a mean.
 *
 * Integer textures are streamed in sparse and dense mode. Use a usampler2D for UINT and an isampler2D for
 * SINT, a descriptor of SluiceVulkanTexture.imageView, with NEAREST filters between texels and between
 * levels, and otherwise as sample.glsl requires. They are not in a streamer's own array of textures.
 * HLSL samples integers from shader model 6.7 on.
 *
 * Write feedback by sluiceWriteFeedback with a LOD bias of 0 and without anisotropy (1).
 *
 * Include the file after the definitions of buffers.glsl.
 */
#ifndef SLUICE_SAMPLE_INTEGER_GLSL
#define SLUICE_SAMPLE_INTEGER_GLSL

#include "sample.glsl"

/* The number where not even the packed levels are resident. Define it before to change it. */
#ifndef SLUICE_FALLBACK_NUMBER
#define SLUICE_FALLBACK_NUMBER 0
#endif

/**
 * Returns the level nearest to the LOD of a sample, halves rounded down, as a sampler chooses it. All
 * texels of the sample are resident there. s.level must not be SLUICE_MIP_UNTOUCHED.
 */
float sluiceNearestLevel(uint tableIndex, SluiceSampling s)
{
    float last = float(sluiceMipCount(sluiceReadGrid(tableIndex)) - 1u);
    return min(max(ceil(s.lod - 0.5), float(s.level)), last);
}

/**
 * Samples with explicit derivatives of `uv` per pixel. Any stage.
 *
 * `missingLevels` is the result of sluiceMissingLevels: 0 when the texture is as sharp as wanted.
 */
uvec4 sluiceSampleUintGrad(SLUICE_USAMPLER_2D(tex), uint tableIndex, vec2 uv, vec2 dx, vec2 dy, out uint missingLevels)
{
    SluiceSampling s = sluiceResolveSampling(tableIndex, uv, dx, dy, 0.0, 1.0);
    missingLevels = sluiceMissingLevels(s);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return SLUICE_SPLAT(uvec4, SLUICE_FALLBACK_NUMBER);
    return SLUICE_TEXTURE_LOD(tex, SLUICE_SAMPLER_OF(tex), s.uv, sluiceNearestLevel(tableIndex, s));
}

/** Samples a SINT texture like sluiceSampleUintGrad. */
ivec4 sluiceSampleIntGrad(SLUICE_ISAMPLER_2D(tex), uint tableIndex, vec2 uv, vec2 dx, vec2 dy, out uint missingLevels)
{
    SluiceSampling s = sluiceResolveSampling(tableIndex, uv, dx, dy, 0.0, 1.0);
    missingLevels = sluiceMissingLevels(s);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return SLUICE_SPLAT(ivec4, SLUICE_FALLBACK_NUMBER);
    return SLUICE_TEXTURE_LOD(tex, SLUICE_SAMPLER_OF(tex), s.uv, sluiceNearestLevel(tableIndex, s));
}

#ifdef SLUICE_FRAGMENT_SHADER

/** Samples like sluiceSampleUintGrad with the fragment's own derivatives. Call in uniform control flow. */
uvec4 sluiceSampleUint(SLUICE_USAMPLER_2D(tex), uint tableIndex, vec2 uv, out uint missingLevels)
{
    return sluiceSampleUintGrad(SLUICE_PASS_SAMPLER(tex), tableIndex, uv, dFdx(uv), dFdy(uv), missingLevels);
}

/** Samples a SINT texture like sluiceSampleUint. */
ivec4 sluiceSampleInt(SLUICE_ISAMPLER_2D(tex), uint tableIndex, vec2 uv, out uint missingLevels)
{
    return sluiceSampleIntGrad(SLUICE_PASS_SAMPLER(tex), tableIndex, uv, dFdx(uv), dFdy(uv), missingLevels);
}

#endif

#endif
