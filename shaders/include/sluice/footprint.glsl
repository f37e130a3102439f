/*
 * Computes the regions of a texture that one sample may touch.
 *
 * A tile of level l covers the regions whose index, shifted right by l, equals the tile's index.
 * Level sizes are rounded down. In textures that do not halve evenly a tile therefore begins up to
 * one texel of its level after its regions, and the box around a sample reaches that much further
 * down.
 *
 * Along an axis it suffices to visit one region per tile of the finest level sampled, and the last
 * region, which may be narrow. All units are texels of level 0. C twin: lib/vulkan/shader_twins.h.
 */
#ifndef SLUICE_FOOTPRINT_GLSL
#define SLUICE_FOOTPRINT_GLSL

#include "buffers.glsl"
#include "lod.glsl"

/*
 * Texels of the coarser level: half a texel for the bilinear filter, and room for fixed-point uv.
 */
#define SLUICE_APRON 0.5625
#define SLUICE_APRON_UNEVEN 1.5625
#define SLUICE_APRON_SPLINE 1.0 /* more of both for textures with a bicubic filter */

/*
 * SLUICE_CUBIC: whether textures with a bicubic filter are sampled with it (sample.glsl).
 * SLUICE_WIDE_APRON: an apron, and the texels that bicubic samples add to it.
 *
 * Shaders that do not define SLUICE_CUBIC have no code of bicubic filters at all. Code behind a constant
 * false costs some compilers speed.
 */
#ifdef SLUICE_CUBIC
#define SLUICE_HAS_CUBIC
#define SLUICE_WIDE_APRON(grid, apron) \
    (SLUICE_CUBIC && (grid.shape & SLUICE_SHAPE_SPLINE) != 0u ? (apron) + SLUICE_APRON_SPLINE : (apron))
#else
#define SLUICE_CUBIC false
#define SLUICE_WIDE_APRON(grid, apron) (apron)
#endif

/*
 * Along an axis of more than 64 tiles steps are longer, and some tiles are skipped. That takes a
 * LOD bias below -5 and anisotropy.
 */
#define SLUICE_FOOTPRINT_STEPS_LOG2 6

/** Regions of a texture, as footprints use them. */
struct SluiceGrid {
    vec2 size;  /* texels of level 0 */
    uint shape; /* SluiceTextureEntry.shape */
    uvec2 last; /* last column and row */
};

SluiceGrid sluiceReadGrid(uint tableIndex)
{
    SluiceGrid grid;
    grid.size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    grid.shape = SLUICE_TEXTURE_ENTRY(tableIndex).shape;
    grid.last = uvec2(SLUICE_TEXTURE_ENTRY(tableIndex).regionLastX,
                      SLUICE_TEXTURE_ENTRY(tableIndex).regionLastY);
    return grid;
}

uint sluiceMipCount(SluiceGrid grid)
{
    return ((grid.shape >> SLUICE_SHAPE_LAST_LEVEL_SHIFT) & 31u) + 1u;
}

/** Returns log2 of a region's width and height. */
uvec2 sluiceRegionShift(SluiceGrid grid)
{
    return uvec2(grid.shape & 31u, (grid.shape >> SLUICE_SHAPE_HEIGHT_SHIFT) & 31u);
}

/** Returns a region's width and height in texels of level 0. */
vec2 sluiceRegionSize(SluiceGrid grid)
{
    return vec2(SLUICE_SPLAT(uvec2, 1u) << sluiceRegionShift(grid));
}

uvec2 sluiceAddressModes(SluiceGrid grid)
{
    return uvec2(grid.shape >> SLUICE_SHAPE_MODE_U_SHIFT, grid.shape >> SLUICE_SHAPE_MODE_V_SHIFT) & 7u;
}

/** Columns and rows of a footprint. If the first is after the last, it wraps around at 0. */
struct SluiceFootprint {
    uvec2 first, last;
};

/** Returns the region of a texel coordinate. At most `last`, also for NaN. */
uint sluiceRegionIndex(float texel, float size, uint shift, uint last)
{
    return min(uint(texel > 0.0 ? min(texel, size) : 0.0) >> shift, last);
}

/**
 * Returns the first and last region along one axis of the interval from `below` before to `above`
 * after the coordinate.
 */
uvec2 sluiceRegionRange(float coordinate, float below, float above, uint addressMode, float size,
                        uint shift, uint last)
{
    float low, high;
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT) {
        if (!(below + above < size)) /* all of the image, and NaN */
            return uvec2(0u, last);
        /* fract first: far from 0 the ends of the box would round to its middle */
        float middle = (coordinate - floor(coordinate)) * size;
        low = middle - below;
        high = middle + above;
        low += low < 0.0 ? size : 0.0;
        high -= high >= size ? size : 0.0;
    } else {
        float middle = coordinate;
        if (addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
            middle = coordinate - 2.0 * floor(coordinate * 0.5);
            middle = middle > 1.0 ? 2.0 - middle : middle;
            below = above = max(below, above);
        } else if (addressMode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE) {
            middle = abs(coordinate);
            below = above = max(below, above);
        }
        /* the ends are clamped, not the middle: a box outside touches no more than the edge */
        low = middle * size - below;
        high = middle * size + above;
    }
    uvec2 range = uvec2(sluiceRegionIndex(low, size, shift, last),
                        sluiceRegionIndex(high, size, shift, last));
    bool wraps = addressMode == SLUICE_ADDRESS_MODE_REPEAT && low > high;
    if (wraps && range.x == range.y) /* around the image, back into the same region */
        return uvec2(0u, last);
    return wraps ? range : uvec2(range.x, max(range.x, range.y)); /* NaN */
}

/**
 * Returns the footprint around `uv` of samples of levels up to `coarsestLevel`. `halfBox` is from
 * sluiceHalfBox.
 */
SluiceFootprint sluiceComputeFootprint(SluiceGrid grid, vec2 uv, vec2 halfBox, uint coarsestLevel)
{
    vec2 texel = min(SLUICE_SPLAT(vec2, uintBitsToFloat((coarsestLevel + 127u) << 23u)), grid.size); /* 2 to the level */
    float below = SLUICE_WIDE_APRON(grid, SLUICE_APRON);
    if ((grid.shape & SLUICE_SHAPE_UNEVEN) != 0u) {
        texel = grid.size / vec2(max(uvec2(grid.size) >> coarsestLevel, 1u));
        below = SLUICE_WIDE_APRON(grid, SLUICE_APRON_UNEVEN);
    }
    uvec2 shift = sluiceRegionShift(grid), modes = sluiceAddressModes(grid);
    uvec2 x = sluiceRegionRange(uv.x, below * texel.x + halfBox.x,
                                SLUICE_WIDE_APRON(grid, SLUICE_APRON) * texel.x + halfBox.x, modes.x,
                                grid.size.x, shift.x, grid.last.x);
    uvec2 y = sluiceRegionRange(uv.y, below * texel.y + halfBox.y,
                                SLUICE_WIDE_APRON(grid, SLUICE_APRON) * texel.y + halfBox.y, modes.y,
                                grid.size.y, shift.y, grid.last.y);
    SluiceFootprint footprint;
    footprint.first = uvec2(x.x, y.x);
    footprint.last = uvec2(x.y, y.y);
    return footprint;
}

/** Returns the step between regions along an axis that visits every tile of `level`. */
uint sluiceRangeStep(uint first, uint last, uint axisLast, uint level)
{
    uint length = last - first + (last < first ? axisLast + 1u : 0u);
    return max(1u << level, (length >> SLUICE_FOOTPRINT_STEPS_LOG2) + 1u);
}

/** Returns the region to visit after `at`, which is not `last`. */
uint sluiceNextRegion(uint at, uint last, uint axisLast, uint step)
{
    if (at < last)
        return min(at + step, last);
    return at < axisLast ? min(at + step, axisLast) : 0u;
}

/**
 * Returns half the size, in texels, of the box that an anisotropic sampler may read in addition to
 * its apron. 0 without anisotropy. Derivatives are in texels.
 *
 * The box is twice the ellipse that the derivatives span, along either axis: some devices round the
 * number of samples up to a power of two and keep their distance. A positive LOD bias enlarges the
 * box: some devices scale the footprint with it, and so do explicit derivatives that include the
 * bias.
 */
vec2 sluiceHalfBox(vec2 dx, vec2 dy, float lodBias, float maxAnisotropy)
{
    if (!(maxAnisotropy > 1.0))
        return SLUICE_SPLAT(vec2, 0.0);
    float scale = lodBias <= 0.0 ? 1.0 : exp2(sluiceClampLodBias(lodBias)); /* NaN is large */
    return scale * vec2(length(vec2(dx.x, dy.x)), length(vec2(dx.y, dy.y)));
}

#endif
