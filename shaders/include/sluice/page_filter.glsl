/*
 * Filters textures whose texels lie in pages: which texels form a bilinear sample, and which
 * bilinear samples form a trilinear or anisotropic one. Finding the texels is left to paged.glsl
 * and demand.glsl.
 */
#ifndef SLUICE_PAGE_FILTER_GLSL
#define SLUICE_PAGE_FILTER_GLSL

#include "language.glsl"
#include "shared/texture_table.h"

/* Steps of filter weights. Devices usually have at least these, and sums of weights stay exactly 1. */
#define SLUICE_FILTER_STEPS 256.0

/* The sampler's border color. Define it before to change it. */
#ifndef SLUICE_BORDER_COLOR
#define SLUICE_BORDER_COLOR SLUICE_SPLAT(vec4, 0.0)
#endif

/** Returns the border color, limited to the components of the format. */
vec4 sluiceBorder(SluiceTextureEntry entry)
{
    uint count = (entry.flags >> SLUICE_TEXTURE_COMPONENTS_SHIFT) & 7u;
    vec4 color = SLUICE_BORDER_COLOR;
    return vec4(color.r, count > 1u ? color.g : 0.0, count > 2u ? color.b : 0.0,
                count > 3u ? color.a : 1.0);
}

/** Axis of a bilinear sample, in texels of a level. */
struct SluicePageAxis {
    int low, high; /* -1: beyond the border */
    float weight;  /* weight of `high` */
};

/**
 * Returns the equivalent coordinate inside the texture. With a border, at most a texel beyond the
 * nearest repetitions. `n` is the size.
 */
float sluiceFoldOntoPages(float coordinate, uint addressMode, float n)
{
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT)
        return coordinate - floor(coordinate);
    if (addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
        coordinate -= 2.0 * floor(coordinate * 0.5);
        return coordinate > 1.0 ? 2.0 - coordinate : coordinate;
    }
    if (addressMode == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER)
        return clamp(coordinate, -1.0 - 1.0 / n, 2.0 + 1.0 / n);
    if (addressMode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE)
        coordinate = abs(coordinate);
    return clamp(coordinate, 0.0, 1.0);
}

/** Returns the axis of a folded coordinate. */
SluicePageAxis sluiceFoldedPageAxis(float coordinate, uint addressMode, int size)
{
    float n = float(size);
    float at = floor(coordinate * n * SLUICE_FILTER_STEPS - (0.5 * SLUICE_FILTER_STEPS - 0.5)) /
               SLUICE_FILTER_STEPS;
    SluicePageAxis axis;
    axis.low = int(floor(at));
    axis.high = axis.low + 1;
    axis.weight = at - floor(at);
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT) {
        axis.low += axis.low < 0 ? size : 0;
        axis.high -= axis.high >= size ? size : 0;
    } else if (addressMode == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER) {
        axis.low = axis.low >= 0 && axis.low < size ? axis.low : -1;
        axis.high = axis.high >= 0 && axis.high < size ? axis.high : -1;
    } else {
        /* mirrored, the texel beyond an edge is that before it */
        axis.low = clamp(axis.low, 0, size - 1);
        axis.high = clamp(axis.high, 0, size - 1);
    }
    return axis;
}

SluicePageAxis sluicePageAxis(float coordinate, uint addressMode, int size)
{
    return sluiceFoldedPageAxis(sluiceFoldOntoPages(coordinate, addressMode, float(size)), addressMode,
                                size);
}

/** Returns the axis of only the nearest texel, for a folded coordinate. */
SluicePageAxis sluiceNearestPageAxis(float coordinate, uint addressMode, int size)
{
    int at = int(floor(coordinate * float(size)));
    int inside = clamp(at, 0, size - 1);
    at = addressMode == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER && at != inside ? -1 : inside;
    SluicePageAxis axis;
    axis.low = axis.high = at;
    axis.weight = 0.0;
    return axis;
}

/** Position of a bilinear sample's four texels in the tiles of a level. */
struct SluicePagePlace {
    vec2 tile;   /* column and row */
    vec2 local;  /* coordinates in the tile, 0 to 1 */
    bool inside; /* all four texels lie in this tile; otherwise, other members are undefined */
};

/**
 * Places a bilinear sample of a level of `size` texels, with float arithmetic only. `share` is 1 divided
 * by the width and height of tiles, powers of two.
 *
 * `uv` must be folded only for REPEAT. Coordinates outside the texture are not inside. All steps after
 * the first are exact, so the results have the same bits as SluicePageAxis.
 */
SluicePagePlace sluicePlaceInTile(vec2 uv, vec2 size, vec2 share)
{
    vec2 at = floor(uv * size * SLUICE_FILTER_STEPS - (0.5 * SLUICE_FILTER_STEPS - 0.5));
    vec2 tiles = at * (share / SLUICE_FILTER_STEPS), end = (size - 1.0) * SLUICE_FILTER_STEPS;
    SluicePagePlace place;
    place.tile = floor(tiles);
    vec2 rest = tiles - place.tile;
    place.local = rest + 0.5 * share;
    place.inside = min(at.x, at.y) >= 0.0 && at.x < end.x && at.y < end.y &&
                   rest.x < 1.0 - share.x && rest.y < 1.0 - share.y;
    return place;
}

/** Returns 1 divided by the width and height of tiles, of which `shift` is log2. */
vec2 sluiceTileShare(ivec2 shift)
{
    return uintBitsToFloat(uvec2(127 - shift) << 23u);
}

/* Without non-uniform indexing every element is visited, and one of them is sampled. */
#ifdef SLUICE_PAGE_LOOP
#define SLUICE_WITH_PAGE(page, statement)                                                          \
    for (uint chunk = 0u; chunk < SLUICE_PAGE_LOOP; chunk++)                                        \
        if (chunk == (page) >> 16u) {                                                              \
            statement;                                                                             \
        }
#else
#define SLUICE_WITH_PAGE(page, statement)                                                          \
    {                                                                                              \
        uint chunk = (page) >> 16u;                                                                \
        statement;                                                                                 \
    }
#endif

/** Bilinear samples of a trilinear or anisotropic sample: a row, each of two levels. */
struct SluicePagedTaps {
    uint fine, coarse; /* levels */
    float fraction;    /* weight of `coarse`: 0 to 1 */
    uint count;
    vec2 axis; /* direction of the row of taps, in uv */
};

/**
 * Places the bilinear samples at `lod`, 0 to the last of `levelCount` levels. `size` is that of
 * level 0. `dx` and `dy` include all LOD bias.
 *
 * Anisotropic samples use up to `maxTaps` (above 1) samples along the longer derivative, one per
 * pixel of the level. This is the common method; every device refines it.
 */
SluicePagedTaps sluicePlaceTaps(vec2 size, uint levelCount, vec2 dx, vec2 dy, float lod, float maxTaps)
{
    SluicePagedTaps taps;
    taps.fine = uint(lod);
    taps.coarse = min(taps.fine + 1u, levelCount - 1u);
    taps.fraction =
        floor((lod - float(taps.fine)) * SLUICE_FILTER_STEPS + 0.5) / SLUICE_FILTER_STEPS;
    taps.count = 1u;
    taps.axis = SLUICE_SPLAT(vec2, 0.0);
    if (maxTaps > 1.0) {
        float x = length(dx * size), y = length(dy * size);
        taps.axis = x >= y ? dx : dy;
        float ratio = max(x, y) / exp2(lod);
        taps.count = uint(clamp(ceil(ratio - 0.01), 1.0, maxTaps));
    }
    return taps;
}

#endif
