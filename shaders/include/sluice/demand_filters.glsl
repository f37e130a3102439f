/*
 * Filters texels of one level of a texture that is loaded on demand: linear or bicubic, with or without
 * derivatives. Only demand.glsl includes it.
 */
#ifndef SLUICE_DEMAND_FILTERS_GLSL
#define SLUICE_DEMAND_FILTERS_GLSL

#include "cubic.glsl"
#include "demand_texels.glsl"

/** Filter within a level. */
struct SluiceDemandKernel {
    bool spline; /* bicubic; false: linear or nearest */
    bool smart;  /* only as far as the texture is magnified */
    bool slopes; /* derivatives, too */
    float lod;   /* wanted, without the loader's bias */
};

/** Returns the filter of a texture. */
SluiceDemandKernel sluiceDemandKernel(uint shape, bool slopes, float lod)
{
    SluiceDemandKernel kernel;
    kernel.spline = (shape & SLUICE_DEMAND_SPLINE) != 0u;
    kernel.smart = (shape & SLUICE_DEMAND_SMART) != 0u;
    kernel.slopes = slopes;
    kernel.lod = lod;
    return kernel;
}

/** Returns how much of what is shown at `lod` is bicubic. */
float sluiceDemandShare(SluiceDemandKernel kernel, float lod)
{
    if (!kernel.spline)
        return 0.0;
    return kernel.smart ? sluiceCubicShare(lod - kernel.lod) : 1.0;
}

/**
 * Returns color and derivatives of a sample of `level`, of which `share` is bicubic. Coarser levels
 * stand in as in sluiceDemandTexels, for all texels of the sample together.
 */
mat3x4 sluiceFilterDemand(inout SluiceDemandState s, uint level, vec2 uv, SluiceDemandKernel kernel,
                          float share)
{
    uint regular = sluiceDemandRegularCount(s.shape);
    uint parts = kernel.slopes && (s.shape & SLUICE_DEMAND_NEAREST) == 0u ? 12u : 4u;
    bool ask = true;
    for (;;) {
        vec2 size = vec2(max(s.size >> level, SLUICE_SPLAT(uvec2, 1u)));
        uint worst = 0u, end = share > 0.0 ? 2u * parts : parts;
        mat3x4 sum = SLUICE_SPLAT(mat3x4, 0.0);
        /* All parts are looked up, so that one launch requests all pages. */
        SLUICE_DONT_UNROLL for (uint i = share < 1.0 ? 0u : parts; i < end; i++) {
            bool cubic = i >= parts;
            uint part = cubic ? i - parts : i, found;
            SluiceFilterPart at = sluiceFindFilterPart(uv, size, cubic, part);
            if (at.weight == 0.0)
                continue;
            vec4 color = sluiceDemandBilinear(s, level, at.uv, ask || level >= regular, found);
            color *= at.weight * (cubic ? share : 1.0 - share);
            worst = max(worst, found);
            if (part < 4u)
                sum[0] += color;
            else if (part < 8u)
                sum[1] += color;
            else
                sum[2] += color;
        }
        if (worst < SLUICE_DEMAND_PAGE_REFUSED)
            return sum;
        if (worst == SLUICE_PAGE_NONE) {
            s.resident = false;
            if (!SLUICE_DEMAND_PREVIEW)
                return SLUICE_SPLAT(mat3x4, 0.0);
            ask = false;
        }
        level = level < regular ? level + 1u : sluiceDemandLastLevel(s.shape);
        share = max(share, sluiceDemandShare(kernel, float(level)));
    }
}

#endif
