/*
 * The functions of sample.glsl and paged.glsl that take a texture. Only sample.glsl includes this
 * file: once for a sampler2D, and once for a number, the argument of SLUICE_TEXTURE. A sampler2D that
 * is chosen by a non-uniform number cannot be an argument: the function's own load of it would not be
 * marked as non-uniform.
 *
 * SLUICE_FORM is the type of the argument; SLUICE_FORM_TEXTURE turns it into a sampler2D. Both are
 * undefined at the end.
 */
#ifdef SLUICE_PAGED
/** Returns a bilinear sample of any level. `tail` has the packed levels. */
vec4 sluiceSampleLevel(SLUICE_FORM(tail), SluiceTextureEntry entry, uint level, vec2 uv)
{
    if (level >= entry.regularMipCount)
        return SLUICE_FORM_LOD(tail, uv, float(level - entry.regularMipCount));
    return sluiceSamplePages(entry, level, uv);
}

vec4 sluiceSampleTail(SLUICE_FORM(tail), SluiceTextureEntry entry, vec2 uv, vec2 dx, vec2 dy)
{
    vec2 scale = sluiceTailScale(entry);
    return SLUICE_FORM_GRAD(tail, uv, dx * scale, dy * scale);
}

/**
 * Samples like a trilinear or anisotropic sampler at `lod`. `dx` and `dy` include all LOD bias.
 */
vec4 sluiceSamplePaged(SLUICE_FORM(tail), SluiceTextureEntry entry, vec2 uv, vec2 dx, vec2 dy,
                       float lod, float maxAnisotropy)
{
    lod = sluiceClampPagedLod(entry, lod);
    if (lod >= float(entry.regularMipCount))
        return sluiceSampleTail(SLUICE_FORM_PASS(tail), entry, uv, dx, dy);
    SluicePagedTaps taps = sluicePlacePagedTaps(entry, dx, dy, lod, maxAnisotropy);
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    for (uint i = 0u; i < taps.count; i++) {
        vec2 at = sluicePagedTap(taps, uv, i);
        vec4 fine = SLUICE_SPLAT(vec4, 0.0), coarse = SLUICE_SPLAT(vec4, 0.0);
        if (taps.fraction < 1.0)
            fine = sluiceSampleLevel(SLUICE_FORM_PASS(tail), entry, taps.fine, at);
        if (taps.fraction > 0.0)
            coarse = sluiceSampleLevel(SLUICE_FORM_PASS(tail), entry, taps.coarse, at);
        sum += sluiceMixLevels(taps, fine, coarse);
    }
    return sum / float(taps.count);
}
#endif

/**
 * Samples after sluiceResolveSampling. For sparse and dense mode. s.level must not be
 * SLUICE_MIP_UNTOUCHED.
 */
vec4 sluiceTextureGrad(SLUICE_FORM(tex), SluiceSampling s)
{
#ifdef SLUICE_MIN_LOD
    return SLUICE_FORM_GRAD_CLAMP(tex, s.uv, s.dx, s.dy, s.minLod);
#else
    return SLUICE_FORM_GRAD(tex, s.uv, s.dx, s.dy);
#endif
}

/** Samples after sluiceResolveSampling with a linear filter, in any mode. */
vec4 sluiceSampleResolved(SLUICE_FORM(tex), uint tableIndex, SluiceSampling s, float maxAnisotropy)
{
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape))
        return sluiceSamplePaged(SLUICE_FORM_PASS(tex), SLUICE_TEXTURE_ENTRY(tableIndex), s.uv, s.dx, s.dy, s.lod,
                                 maxAnisotropy);
#endif
    return sluiceTextureGrad(SLUICE_FORM_PASS(tex), s);
}

/** Returns a bilinear sample of one level, in any mode. */
vec4 sluiceSampleAtLevel(SLUICE_FORM(tex), uint tableIndex, uint level, vec2 uv)
{
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape))
        return sluiceSampleLevel(SLUICE_FORM_PASS(tex), SLUICE_TEXTURE_ENTRY(tableIndex), level, uv);
#endif
    return SLUICE_FORM_LOD(tex, uv, float(level));
}

/**
 * Sums color and derivatives of a sample of s.lod, of which `share` is bicubic. With `slopes` false the
 * bicubic color alone.
 */
mat3x4 sluiceSampleKernels(SLUICE_FORM(tex), uint tableIndex, SluiceSampling s, float maxAnisotropy,
                           float share, bool slopes)
{
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    uint count = SLUICE_TEXTURE_ENTRY(tableIndex).mipLevelCount;
    SluicePagedTaps taps = sluicePlaceTaps(size, count, s.dx, s.dy, clamp(s.lod, 0.0, float(count - 1u)),
                                           sluiceClampAnisotropy(maxAnisotropy));
    uint parts = slopes ? 12u : 4u;
    uint first = slopes && share < 1.0 ? 0u : parts, end = share > 0.0 ? 2u * parts : parts;
    mat3x4 sum = SLUICE_SPLAT(mat3x4, 0.0);
    for (uint i = 0u; i < 2u * taps.count; i++) {
        bool coarse = i >= taps.count;
        float levelWeight = (coarse ? taps.fraction : 1.0 - taps.fraction) / float(taps.count);
        if (!(levelWeight > 0.0))
            continue;
        uint level = coarse ? taps.coarse : taps.fine;
        vec2 levelSize = vec2(max(uvec2(size) >> level, SLUICE_SPLAT(uvec2, 1u)));
        float along = (float(coarse ? i - taps.count : i) + 0.5) / float(taps.count) - 0.5;
        for (uint j = first; j < end; j++) {
            bool cubic = j >= parts;
            uint part = cubic ? j - parts : j;
            SluiceFilterPart at = sluiceFindFilterPart(s.uv + taps.axis * along, levelSize, cubic, part);
            float weight = at.weight * levelWeight;
            if (slopes)
                weight *= cubic ? share : 1.0 - share;
            if (weight == 0.0)
                continue;
            vec4 color = weight * sluiceSampleAtLevel(SLUICE_FORM_PASS(tex), tableIndex, level, at.uv);
            if (part < 4u)
                sum[0] += color;
            else if (part < 8u)
                sum[1] += color;
            else
                sum[2] += color;
        }
    }
    return sum;
}

/** Samples a texture with a bicubic filter. */
vec4 sluiceSampleSpline(SLUICE_FORM(tex), uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                        float maxAnisotropy, out uint missingLevels)
{
    SluiceSampling s = sluiceFindSampling(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    missingLevels = sluiceMissingLevels(s);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return SLUICE_FALLBACK_COLOR;
    float share = sluiceSplineShare(tableIndex, s, dx, dy, lodBias, maxAnisotropy);
    vec4 color = SLUICE_SPLAT(vec4, 0.0);
    if (share < 1.0)
        color = (1.0 - share) * sluiceSampleResolved(SLUICE_FORM_PASS(tex), tableIndex, s, maxAnisotropy);
    if (share > 0.0)
        color += share * sluiceSampleKernels(SLUICE_FORM_PASS(tex), tableIndex, s, maxAnisotropy, 1.0, false)[0];
    return color;
}

/**
 * Samples like sluiceSampleGrad, and returns the derivatives of the color by u and by v, for example of a
 * height for bump mapping. Any stage. Filters as sluiceSampleGrad does.
 *
 * `du` and `dv` are per unit of uv: the change across the whole texture. They are exact derivatives of
 * the color at an unchanged LOD. So with a linear filter they are constant between texels and jump
 * at their centers; with a bicubic filter they are continuous. They are 0 where nothing is resident. All
 * samples have computed levels, as in paged mode. For formats without a linear filter they are
 * differences of neighboring texels.
 */
vec4 sluiceSampleDerivatives(SLUICE_FORM(tex), uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                             float maxAnisotropy, out vec4 du, out vec4 dv, out uint missingLevels)
{
    SluiceSampling s = sluiceFindSampling(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    missingLevels = sluiceMissingLevels(s);
    mat3x4 sum = mat3x4(SLUICE_FALLBACK_COLOR, SLUICE_SPLAT(vec4, 0.0), SLUICE_SPLAT(vec4, 0.0));
    if (s.level != SLUICE_MIP_UNTOUCHED)
        sum = sluiceSampleKernels(SLUICE_FORM_PASS(tex), tableIndex, s, maxAnisotropy,
                                  sluiceSplineShare(tableIndex, s, dx, dy, lodBias, maxAnisotropy), true);
    du = sum[1];
    dv = sum[2];
    return sum[0];
}

#ifdef SLUICE_PAGED
/** Samples in paged mode if everything is resident. */
vec4 sluiceSampleAsPages(SLUICE_FORM(tex), uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                         float maxAnisotropy)
{
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    vec2 size = vec2(entry.sizeX, entry.sizeY);
    float scale = exp2(sluiceClampLodBias(lodBias));
    return sluiceSamplePaged(SLUICE_FORM_PASS(tex), entry, uv, dx * scale, dy * scale,
                             sluiceComputeLod(dx * size, dy * size, lodBias, maxAnisotropy),
                             maxAnisotropy);
}
#endif

/**
 * Samples with explicit derivatives of `uv` per pixel. Any stage.
 *
 * `missingLevels` is the result of sluiceMissingLevels: 0 when the texture is as sharp as wanted.
 */
vec4 sluiceSampleGrad(SLUICE_FORM(tex), uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                      float maxAnisotropy, out uint missingLevels)
{
#ifdef SLUICE_HAS_CUBIC
    if (SLUICE_CUBIC && sluiceHasSpline(tableIndex))
        return sluiceSampleSpline(SLUICE_FORM_PASS(tex), tableIndex, uv, dx, dy, lodBias, maxAnisotropy, missingLevels);
#endif
    if (sluiceIsSurelyThere(tableIndex, uv, dx, dy, lodBias, maxAnisotropy)) {
        float scale = exp2(sluiceClampLodBias(lodBias));
        missingLevels = 0u;
#ifdef SLUICE_PAGED
        if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape))
            return sluiceSampleAsPages(SLUICE_FORM_PASS(tex), tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
#endif
        return SLUICE_FORM_GRAD(tex, uv, dx * scale, dy * scale);
    }
    SluiceSampling s = sluiceResolveSampling(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    missingLevels = sluiceMissingLevels(s);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return SLUICE_FALLBACK_COLOR;
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape))
        return sluiceSamplePaged(SLUICE_FORM_PASS(tex), SLUICE_TEXTURE_ENTRY(tableIndex), s.uv, s.dx, s.dy, s.lod,
                                 maxAnisotropy);
#endif
    return sluiceTextureGrad(SLUICE_FORM_PASS(tex), s);
}

/** Fetches one texel. It must be resident: see sluiceResolveSampling. */
vec4 sluiceTexelFetch(SLUICE_FORM(tex), uint tableIndex, ivec2 texel, uint level)
{
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape)) {
        SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
        if (level < entry.regularMipCount)
            return sluiceFetchPaged(entry, level, texel);
        return SLUICE_FORM_FETCH(tex, texel, int(level - entry.regularMipCount));
    }
#endif
    return SLUICE_FORM_FETCH(tex, texel, int(level));
}

#ifdef SLUICE_FRAGMENT_SHADER

/**
 * Samples like sluiceSampleGrad with the fragment's own derivatives. Call in control flow that is
 * uniform over the quad. A number for SLUICE_TEXTURE, and its tableIndex, may differ in the quad.
 */
vec4 sluiceSample(SLUICE_FORM(tex), uint tableIndex, vec2 uv, float lodBias, float maxAnisotropy,
                  out uint missingLevels)
{
#ifdef SLUICE_FORM_IS_NUMBER
    /* Implicit derivatives need a quad that samples one texture. */
    bool differs = sluiceDiffersInQuad(tex), other = sluiceDiffersInQuad(tableIndex);
    if (differs || other)
        return sluiceSampleGrad(SLUICE_FORM_PASS(tex), tableIndex, uv, dFdx(uv), dFdy(uv), lodBias, maxAnisotropy,
                                missingLevels);
#endif
#ifdef SLUICE_HAS_CUBIC
    if (SLUICE_CUBIC && sluiceHasSpline(tableIndex))
        return sluiceSampleSpline(SLUICE_FORM_PASS(tex), tableIndex, uv, dFdx(uv), dFdy(uv), lodBias, maxAnisotropy,
                                  missingLevels);
#endif
    missingLevels = 0u;
    if (sluiceIsWhole(tableIndex, lodBias, maxAnisotropy)) {
        bool finite = sluiceIsFinite(uv);
        vec4 color = SLUICE_FORM_BIAS(tex, finite ? uv : SLUICE_SPLAT(vec2, 0.0), lodBias);
        return finite ? color : SLUICE_FORM_LOD(tex, SLUICE_SPLAT(vec2, 0.0), SLUICE_LOD_LIMIT);
    }
    vec2 dx = dFdx(uv);
    vec2 dy = dFdy(uv);
    bool sure = abs(lodBias) <= SLUICE_MAX_IMPLICIT_LOD_BIAS &&
                sluiceIsSurelyThere(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape) && sure)
        return sluiceSampleAsPages(SLUICE_FORM_PASS(tex), tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
#endif
    /* The quad decides as one, because implicit derivatives need all of it. */
    if (!sluiceAnyInQuad(!sure))
        return SLUICE_FORM_BIAS(tex, uv, lodBias);
    SluiceSampling s = sluiceResolveSampling(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    missingLevels = sluiceMissingLevels(s);
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape)) {
        if (s.level == SLUICE_MIP_UNTOUCHED)
            return SLUICE_FALLBACK_COLOR;
        return sluiceSamplePaged(SLUICE_FORM_PASS(tex), SLUICE_TEXTURE_ENTRY(tableIndex), s.uv, s.dx, s.dy, s.lod,
                                 maxAnisotropy);
    }
#endif
    if (!sluiceAnyInQuad(!(s.plain && abs(lodBias) <= SLUICE_MAX_IMPLICIT_LOD_BIAS)))
        return SLUICE_FORM_BIAS(tex, uv, lodBias);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return SLUICE_FALLBACK_COLOR;
#ifndef SLUICE_MIN_LOD
    if (!(maxAnisotropy > 1.0)) /* derivatives need not be kept until here */
        return SLUICE_FORM_LOD(tex, s.uv, s.lod);
#endif
    return sluiceTextureGrad(SLUICE_FORM_PASS(tex), s);
}

#endif

#undef SLUICE_FORM
#undef SLUICE_FORM_PASS
#undef SLUICE_FORM_SAMPLER
#undef SLUICE_FORM_TEXTURE
