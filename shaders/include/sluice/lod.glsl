/*
 * The level of detail that a sampler will choose, computed from derivatives.
 *
 * Vulkan lets implementations approximate; docs/drivers.md has what was measured: up to 0.12 finer
 * than the formula. Whoever must not miss a level subtracts sluiceLodMargin. Some devices take the
 * lengths of the two derivatives, and some the axes of the ellipse that they span: where the
 * derivatives are not at right angles its shorter axis is shorter, and its longer one up to half a
 * level longer. Here the finer and the coarser of the two count. C twin: lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_LOD_GLSL
#define SLUICE_LOD_GLSL

#include "shared/texture_table.h"

/* Ends of the range in which everything is computed; beyond them there are no levels. */
#define SLUICE_LOD_LIMIT 32.0

/** The anisotropy that counts: 1 to 16, 1 for NaN. */
float sluiceClampAnisotropy(float maxAnisotropy)
{
    return maxAnisotropy > 1.0 ? min(maxAnisotropy, 16.0) : 1.0;
}

/** And finite in texels too, of an image of any size: samplers make NaN of what is not. */
bool sluiceIsFinite(vec2 v)
{
    return abs(v.x) <= 1.0e33 && abs(v.y) <= 1.0e33;
}

/** The LOD that counts: -32 to 32, 32 for NaN. */
float sluiceClampLod(float lod)
{
    return lod <= SLUICE_LOD_LIMIT ? max(lod, -SLUICE_LOD_LIMIT) : SLUICE_LOD_LIMIT;
}

/** The LOD bias that counts: -32 to 32, 32 for NaN. */
float sluiceClampLodBias(float lodBias)
{
    return sluiceClampLod(lodBias);
}

/* How far the sampler's level may lie above the coarser rule: as far as below the other. */
#define SLUICE_LOD_COARSER_MARGIN 0.125

/** How far the sampler's level may lie below the computed one. */
float sluiceLodMargin(float maxAnisotropy)
{
    return maxAnisotropy > 1.0 ? 0.1875 : 0.125;
}

/**
 * The LOD that a sampler will choose, the finest (x, without sluiceLodMargin) and the coarsest (y,
 * margin included) that devices come to. `dx` and `dy` in texels of level 0 per pixel. Both are
 * finite, -32 to 32, whatever the arguments: no derivative gives -32, an infinite one or NaN 32.
 */
vec2 sluiceComputeLods(vec2 dx, vec2 dy, float lodBias, float maxAnisotropy)
{
    float x2 = dx.x * dx.x + dx.y * dx.y;
    float y2 = dy.x * dy.x + dy.y * dy.y;
    if (!(x2 >= 0.0 && y2 >= 0.0)) /* NaN */
        return vec2(SLUICE_LOD_LIMIT);
    float n = sluiceClampAnisotropy(maxAnisotropy);
    vec2 major2 = vec2(max(x2, y2));
    vec2 minor2 = vec2(min(x2, y2));
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

/** The finest of them. */
float sluiceComputeLod(vec2 dx, vec2 dy, float lodBias, float maxAnisotropy)
{
    return sluiceComputeLods(dx, dy, lodBias, maxAnisotropy).x;
}

/*
 * The same, 4 to the power of LODs, without bias and margins: so levels are found by exponents alone.
 * `widest` is the coarsest LOD without anisotropy. Where `sum`, of the squared lengths of both
 * derivatives, is not below SLUICE_QUICK_SQUARES they are not to be used.
 */
struct SluiceSquares {
    float fine, coarse, widest, sum;
};

#define SLUICE_QUICK_SQUARES 1.0e14
/* Beyond it nothing is quick. */
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

/** floor(log4(x)) of a number that is not negative, 0 below 4; by its exponent alone. */
uint sluiceFloorLog4(float x)
{
    return uint(max(int(floatBitsToUint(x) >> 23u) - 127, 0)) >> 1u;
}

/** The finest LOD that a texel of the MinMip buffer allows to samplers of that margin. */
float sluiceLodLimit(uint shown, float margin)
{
    return shown == 0u ? -SLUICE_LOD_LIMIT
                       : (float(shown) - float(SLUICE_SHOWN_MARGIN)) / float(SLUICE_SHOWN_STEPS) + margin;
}

/** The finest level whose tiles are sure to be resident, by a texel of the MinMip buffer. */
uint sluiceShownLevel(uint shown)
{
    return (max(shown, uint(SLUICE_SHOWN_MARGIN)) - uint(SLUICE_SHOWN_MARGIN)) / uint(SLUICE_SHOWN_STEPS);
}

/** The finest level of `count` that a sampler may touch at this LOD. */
uint sluiceFinestLevel(float lod, float margin, uint count)
{
    return uint(clamp(lod - margin, 0.0, float(count - 1u)));
}

/** The coarsest level of `count` that a sampler may touch at this LOD. */
uint sluiceCoarsestLevel(float lod, uint count)
{
    return min(uint(clamp(lod, 0.0, float(count - 1u))) + 1u, count - 1u);
}

/**
 * The levels that a sample marks, of `count`, by exponents: the finest, the coarsest, and that without
 * anisotropy.
 */
uvec3 sluiceQuickLevels(SluiceSquares squares, float lodBias, float maxAnisotropy, uint count)
{
    float scale = exp2(2.0 * lodBias);
    float margin = maxAnisotropy > 1.0 ? SLUICE_MARGIN_ANISOTROPIC_4 : SLUICE_MARGIN_4;
    return min(uvec3(sluiceFloorLog4(squares.fine * scale * margin),
                     sluiceFloorLog4(squares.coarse * scale * SLUICE_MARGIN_COARSER_4) + 1u,
                     sluiceFloorLog4(squares.widest * scale * SLUICE_MARGIN_COARSER_4) + 1u),
               uvec3(count - 1u));
}

/** The same by logarithms, whatever the arguments. */
uvec3 sluiceSafeLevels(vec2 uv, vec2 dx, vec2 dy, float lodBias, float maxAnisotropy, uint count)
{
    if (!sluiceIsFinite(uv))
        return uvec3(count - 1u);
    vec2 lods = sluiceComputeLods(dx, dy, lodBias, maxAnisotropy);
    return uvec3(sluiceFinestLevel(lods.x, sluiceLodMargin(maxAnisotropy), count),
                 sluiceCoarsestLevel(lods.y, count),
                 sluiceCoarsestLevel(sluiceComputeLods(dx, dy, lodBias, 1.0).y, count));
}

#endif
