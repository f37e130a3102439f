/*
 * Computes from derivatives the level of detail (LOD) that a sampler will choose.
 *
 * Vulkan lets devices approximate: up to 0.12 finer than the formula was measured
 * (docs/drivers.md). Subtract sluiceLodMargin where no level may be missed. Some devices use the
 * lengths of the two derivatives, some the axes of the ellipse that they span. If the derivatives
 * are not orthogonal, the ellipse's short axis is shorter and its long axis up to half a level
 * longer. The functions here return the finer and the coarser result. C twin:
 * lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_LOD_GLSL
#define SLUICE_LOD_GLSL

#include "language.glsl"
#include "shared/texture_table.h"

/* LODs are clamped to +- this. There are no levels beyond. */
#define SLUICE_LOD_LIMIT 32.0

/** Clamps an anisotropy to 1 to 16. 1 for NaN. */
float sluiceClampAnisotropy(float maxAnisotropy)
{
    return maxAnisotropy > 1.0 ? min(maxAnisotropy, 16.0) : 1.0;
}

/**
 * Returns whether a vector is finite, also when scaled to texels of any image. Otherwise samplers
 * produce NaN.
 */
bool sluiceIsFinite(vec2 v)
{
    return abs(v.x) <= 1.0e33 && abs(v.y) <= 1.0e33;
}

/** Clamps a LOD to -32 to 32. 32 for NaN. */
float sluiceClampLod(float lod)
{
    return lod <= SLUICE_LOD_LIMIT ? max(lod, -SLUICE_LOD_LIMIT) : SLUICE_LOD_LIMIT;
}

/** Clamps a LOD bias to -32 to 32. 32 for NaN. */
float sluiceClampLodBias(float lodBias)
{
    return sluiceClampLod(lodBias);
}

/* Largest excess of the sampler's LOD over the coarser rule. */
#define SLUICE_LOD_COARSER_MARGIN 0.125

/** Returns how much finer the sampler's LOD may be than the computed one. */
float sluiceLodMargin(float maxAnisotropy)
{
    return maxAnisotropy > 1.0 ? 0.1875 : 0.125;
}

/**
 * Returns the LODs that devices choose: the finest (x, without sluiceLodMargin) and the coarsest
 * (y, with margin).
 *
 * `dx` and `dy` are in texels of level 0 per pixel. Results are finite for all arguments, -32 to
 * 32: -32 for derivatives of 0, 32 for infinity or NaN.
 */
vec2 sluiceComputeLods(vec2 dx, vec2 dy, float lodBias, float maxAnisotropy)
{
    float x2 = dx.x * dx.x + dx.y * dx.y;
    float y2 = dy.x * dy.x + dy.y * dy.y;
    if (!(x2 >= 0.0 && y2 >= 0.0)) /* NaN */
        return SLUICE_SPLAT(vec2, SLUICE_LOD_LIMIT);
    float n = sluiceClampAnisotropy(maxAnisotropy);
    vec2 major2 = SLUICE_SPLAT(vec2, max(x2, y2));
    vec2 minor2 = SLUICE_SPLAT(vec2, min(x2, y2));
    float sum = x2 + y2;
    if (sum > 1.0e-30 && sum < 1.0e30) { /* beyond, the squares leave the range */
        float area = (dx.x * dy.y - dx.y * dy.x) / sum; /* -1/2 to 1/2 */
        float root = 1.0 + sqrt(max(1.0 - 4.0 * area * area, 0.0));
        minor2.x = min(minor2.x, 2.0 * area * area * sum / root);
        major2.y = max(major2.y, 0.5 * root * sum);
    }
    minor2 = max(minor2, major2 / (n * n));
    vec2 lods = 0.5 * log2(clamp(minor2, 5.4e-20, 1.8e19)); /* 2^-64 to 2^64 */
    lods += sluiceClampLodBias(lodBias) + vec2(0.0, SLUICE_LOD_COARSER_MARGIN);
    return clamp(lods, -SLUICE_LOD_LIMIT, SLUICE_LOD_LIMIT);
}

/** Returns the finest LOD of sluiceComputeLods. */
float sluiceComputeLod(vec2 dx, vec2 dy, float lodBias, float maxAnisotropy)
{
    if (!(maxAnisotropy > 1.0)) { /* the longer derivative decides */
        float x2 = dx.x * dx.x + dx.y * dx.y;
        float y2 = dy.x * dy.x + dy.y * dy.y;
        if (!(x2 >= 0.0 && y2 >= 0.0)) /* NaN */
            return SLUICE_LOD_LIMIT;
        float lod = 0.5 * log2(clamp(max(x2, y2), 5.4e-20, 1.8e19)) + sluiceClampLodBias(lodBias);
        return clamp(lod, -SLUICE_LOD_LIMIT, SLUICE_LOD_LIMIT);
    }
    return sluiceComputeLods(dx, dy, lodBias, maxAnisotropy).x;
}

/*
 * LODs as powers of 4, without bias and margins, so that levels follow from exponents alone.
 *
 * `widest` is the coarsest LOD without anisotropy. `sum` is the sum of the squared lengths of both
 * derivatives. Do not use the values if it is not below SLUICE_QUICK_SQUARES.
 */
struct SluiceSquares {
    float fine, coarse, widest, sum;
};

#define SLUICE_QUICK_SQUARES 1.0e14
/* Largest LOD bias of the quick path. */
#define SLUICE_QUICK_BIAS 16.0
/* 4 to the power of the margins: -1/8 and, with anisotropy, -3/16; and of the coarser one. With room for
 * what devices' exp2 and log2 are off, so that no more is sampled than is marked. */
#define SLUICE_MARGIN_4 0.84087
#define SLUICE_MARGIN_ANISOTROPIC_4 0.77108
#define SLUICE_MARGIN_COARSER_4 1.18924

SluiceSquares sluiceSquareLods(vec2 dx, vec2 dy, float maxAnisotropy)
{
    float x2 = dx.x * dx.x + dx.y * dx.y;
    float y2 = dy.x * dy.x + dy.y * dy.y;
    float area = dx.x * dy.y - dx.y * dy.x;
    float major = max(x2, y2);
    SluiceSquares s;
    s.sum = x2 + y2;
    s.widest = max(0.5 * (s.sum + sqrt(max(s.sum * s.sum - 4.0 * area * area, 0.0))), major);
    s.fine = major;
    s.coarse = s.widest;
    if (maxAnisotropy > 1.0) {
        float n = sluiceClampAnisotropy(maxAnisotropy);
        float minor = min(x2, y2);
        s.fine = max(min(minor, area * area / max(s.widest, 1.0e-30)), major / (n * n));
        s.coarse = max(minor, s.widest / (n * n));
    }
    return s;
}

/** Returns floor(log4(x)) of a non-negative number from its exponent. 0 below 4. */
uint sluiceFloorLog4(float x)
{
    return uint(max(int(floatBitsToUint(x) >> 23u) - 127, 0)) >> 1u;
}

/**
 * Returns the finest LOD that a texel of the MinMip buffer allows to samplers with this margin.
 */
float sluiceLodLimit(uint shown, float margin)
{
    return shown == 0u ? -SLUICE_LOD_LIMIT
                       : (float(shown) - float(SLUICE_SHOWN_MARGIN)) / float(SLUICE_SHOWN_STEPS) + margin;
}

/**
 * Returns the finest level whose tiles are certainly resident, from a texel of the MinMip buffer.
 */
uint sluiceShownLevel(uint shown)
{
    return (max(shown, uint(SLUICE_SHOWN_MARGIN)) - uint(SLUICE_SHOWN_MARGIN)) / uint(SLUICE_SHOWN_STEPS);
}

/** Returns the finest of `count` levels that a sampler may touch at this LOD. */
uint sluiceFinestLevel(float lod, float margin, uint count)
{
    return uint(clamp(lod - margin, 0.0, float(count - 1u)));
}

/** Returns the coarsest of `count` levels that a sampler may touch at this LOD. */
uint sluiceCoarsestLevel(float lod, uint count)
{
    return min(uint(clamp(lod, 0.0, float(count - 1u))) + 1u, count - 1u);
}

/**
 * Returns the levels that a sample marks, of `count`: finest, coarsest, coarsest without
 * anisotropy. Uses exponents.
 */
uvec3 sluiceQuickLevels(SluiceSquares squares, float lodBias, float maxAnisotropy, uint count)
{
    float scale = exp2(2.0 * lodBias);
    float margin = maxAnisotropy > 1.0 ? SLUICE_MARGIN_ANISOTROPIC_4 : SLUICE_MARGIN_4;
    return min(uvec3(sluiceFloorLog4(squares.fine * scale * margin),
                     sluiceFloorLog4(squares.coarse * scale * SLUICE_MARGIN_COARSER_4) + 1u,
                     sluiceFloorLog4(squares.widest * scale * SLUICE_MARGIN_COARSER_4) + 1u),
               SLUICE_SPLAT(uvec3, count - 1u));
}

/** Returns the levels of sluiceQuickLevels for any arguments. Uses logarithms. */
uvec3 sluiceSafeLevels(vec2 uv, vec2 dx, vec2 dy, float lodBias, float maxAnisotropy, uint count)
{
    if (!sluiceIsFinite(uv))
        return SLUICE_SPLAT(uvec3, count - 1u);
    vec2 lods = sluiceComputeLods(dx, dy, lodBias, maxAnisotropy);
    return uvec3(sluiceFinestLevel(lods.x, sluiceLodMargin(maxAnisotropy), count),
                 sluiceCoarsestLevel(lods.y, count),
                 sluiceCoarsestLevel(sluiceComputeLods(dx, dy, lodBias, 1.0).y, count));
}

#endif
