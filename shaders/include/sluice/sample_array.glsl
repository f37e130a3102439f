/*
 * Samples the layers of a streamed array (sluiceAddVulkanTextureArray) through one sampler2DArray,
 * a descriptor of SluiceVulkanTexture.arrayView. The layer may differ from pixel to pixel.
 *
 * Each layer is a streamed texture of its own, so every function takes two numbers, which need not
 * be uniform:
 *
 *     tableIndex   SluiceVulkanTexture.tableIndex of the layer: that of layer 0, plus layer
 *     layer        SluiceVulkanTexture.arrayLayer, below the number of layers
 *
 * The result equals a sample of the layer's own imageView by sample.glsl, and the sampler must meet
 * the same requirements. Write feedback for the layer's texture: sluiceWriteFeedback with its
 * tableIndex.
 *
 * In sparse and dense mode the view has all levels. In paged mode it has the packed levels of all
 * layers; other tiles are pages, as for any texture.
 *
 * Include it after the definitions of buffers.glsl.
 */
#ifndef SLUICE_SAMPLE_ARRAY_GLSL
#define SLUICE_SAMPLE_ARRAY_GLSL

#include "sample.glsl"

/**
 * Samples a layer after sluiceResolveSampling with its tableIndex. For sparse and dense mode.
 * s.level must not be SLUICE_MIP_UNTOUCHED.
 */
vec4 sluiceTextureArrayGrad(SLUICE_SAMPLER_2D_ARRAY(tex), uint layer, SluiceSampling s)
{
    vec3 at = vec3(s.uv, float(layer));
#ifdef SLUICE_MIN_LOD
    return SLUICE_TEXTURE_GRAD_CLAMP(tex, SLUICE_SAMPLER_OF(tex), at, s.dx, s.dy, s.minLod);
#else
    return SLUICE_TEXTURE_GRAD(tex, SLUICE_SAMPLER_OF(tex), at, s.dx, s.dy);
#endif
}

#ifdef SLUICE_PAGED
/** Returns a bilinear sample of any level. `tail` has the packed levels of all layers. */
vec4 sluiceSampleArrayLevel(SLUICE_SAMPLER_2D_ARRAY(tail), uint layer, SluiceTextureEntry entry, uint level,
                            vec2 uv)
{
    if (level >= entry.regularMipCount)
        return SLUICE_TEXTURE_LOD(tail, SLUICE_SAMPLER_OF(tail), vec3(uv, float(layer)),
                                  float(level - entry.regularMipCount));
    return sluiceSamplePages(entry, level, uv);
}

/** Samples a layer like sluiceSamplePaged. */
vec4 sluiceSamplePagedArray(SLUICE_SAMPLER_2D_ARRAY(tail), uint layer, SluiceTextureEntry entry, vec2 uv,
                            vec2 dx, vec2 dy, float lod, float maxAnisotropy)
{
    lod = sluiceClampPagedLod(entry, lod);
    if (lod >= float(entry.regularMipCount)) {
        vec2 scale = sluiceTailScale(entry);
        return SLUICE_TEXTURE_GRAD(tail, SLUICE_SAMPLER_OF(tail), vec3(uv, float(layer)), dx * scale, dy * scale);
    }
    SluicePagedTaps taps = sluicePlacePagedTaps(entry, dx, dy, lod, maxAnisotropy);
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    for (uint i = 0u; i < taps.count; i++) {
        vec2 at = sluicePagedTap(taps, uv, i);
        vec4 fine = SLUICE_SPLAT(vec4, 0.0), coarse = SLUICE_SPLAT(vec4, 0.0);
        if (taps.fraction < 1.0)
            fine = sluiceSampleArrayLevel(SLUICE_PASS_SAMPLER(tail), layer, entry, taps.fine, at);
        if (taps.fraction > 0.0)
            coarse = sluiceSampleArrayLevel(SLUICE_PASS_SAMPLER(tail), layer, entry, taps.coarse, at);
        sum += sluiceMixLevels(taps, fine, coarse);
    }
    return sum / float(taps.count);
}
#endif

/**
 * Samples a layer like sluiceSampleGrad, with explicit derivatives of `uv` per pixel. Any stage.
 *
 * `missingLevels` is the number of levels by which the sample is too coarse; SLUICE_MIP_UNTOUCHED
 * if it is SLUICE_FALLBACK_COLOR.
 */
vec4 sluiceSampleArrayGrad(SLUICE_SAMPLER_2D_ARRAY(tex), uint tableIndex, uint layer, vec2 uv, vec2 dx, vec2 dy,
                           float lodBias, float maxAnisotropy, out uint missingLevels)
{
    missingLevels = 0u;
    if (sluiceIsSurelyThere(tableIndex, uv, dx, dy, lodBias, maxAnisotropy)) {
        float scale = exp2(sluiceClampLodBias(lodBias));
#ifdef SLUICE_PAGED
        if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape)) {
            SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
            vec2 size = vec2(entry.width, entry.height);
            float lod = sluiceComputeLod(dx * size, dy * size, lodBias, maxAnisotropy);
            return sluiceSamplePagedArray(SLUICE_PASS_SAMPLER(tex), layer, entry, uv, dx * scale, dy * scale, lod,
                                          maxAnisotropy);
        }
#endif
        return SLUICE_TEXTURE_GRAD(tex, SLUICE_SAMPLER_OF(tex), vec3(uv, float(layer)), dx * scale, dy * scale);
    }
    SluiceSampling s = sluiceResolveSampling(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    missingLevels = sluiceMissingLevels(s);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return SLUICE_FALLBACK_COLOR;
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape))
        return sluiceSamplePagedArray(SLUICE_PASS_SAMPLER(tex), layer, SLUICE_TEXTURE_ENTRY(tableIndex), s.uv, s.dx, s.dy,
                                      s.lod, maxAnisotropy);
#endif
    return sluiceTextureArrayGrad(SLUICE_PASS_SAMPLER(tex), layer, s);
}

#ifdef SLUICE_FRAGMENT_SHADER

/** sluiceSample of a layer: the fragment's own derivatives, in control flow that is uniform over the
 *  quad. Layer and tableIndex may differ inside it. */
vec4 sluiceSampleArray(SLUICE_SAMPLER_2D_ARRAY(tex), uint tableIndex, uint layer, vec2 uv, float lodBias,
                       float maxAnisotropy, out uint missingLevels)
{
    vec2 dx = dFdx(uv);
    vec2 dy = dFdy(uv);
    missingLevels = 0u;
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape))
        return sluiceSampleArrayGrad(SLUICE_PASS_SAMPLER(tex), tableIndex, layer, uv, dx, dy, lodBias, maxAnisotropy,
                                     missingLevels);
#endif
    vec3 at = vec3(uv, float(layer));
    bool implicitly = abs(lodBias) <= SLUICE_MAX_IMPLICIT_LOD_BIAS;
    bool sure = implicitly && sluiceIsSurelyThere(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    /* The quad decides as one, because implicit derivatives need all of it. */
    if (!sluiceAnyInQuad(!sure))
        return SLUICE_TEXTURE_BIAS(tex, SLUICE_SAMPLER_OF(tex), at, lodBias);
    SluiceSampling s = sluiceResolveSampling(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    missingLevels = sluiceMissingLevels(s);
    if (!sluiceAnyInQuad(!(s.plain && implicitly)))
        return SLUICE_TEXTURE_BIAS(tex, SLUICE_SAMPLER_OF(tex), at, lodBias);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return SLUICE_FALLBACK_COLOR;
#ifndef SLUICE_MIN_LOD
    if (!(maxAnisotropy > 1.0)) /* isotropic, like in sluiceSample */
        return SLUICE_TEXTURE_LOD(tex, SLUICE_SAMPLER_OF(tex), vec3(s.uv, float(layer)), s.lod);
#endif
    return sluiceTextureArrayGrad(SLUICE_PASS_SAMPLER(tex), layer, s);
}

#endif

#endif
