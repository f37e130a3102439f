/*
 * Samples textures whose tiles are pages: layers of array images, found through the page table.
 *
 * A bilinear sample whose four texels lie in one page is one hardware sample of that layer. Where it
 * crosses the border of a page, or wraps around the texture, its texels are fetched one by one and
 * weighted as the hardware does: in steps of 1/256 texel. So pages need no gutters, and any filter
 * width is right. Levels that are packed are sampled from the texture's own image, by the sampler
 * that came with it.
 *
 * Only sample.glsl and residency.glsl include this, where SLUICE_PAGED is defined: see buffers.glsl.
 */
#ifndef SLUICE_PAGED_GLSL
#define SLUICE_PAGED_GLSL

#include "buffers.glsl"
#include "lod.glsl"

/* As the sampler has it. Define it before to change it. */
#ifndef SLUICE_BORDER_COLOR
#define SLUICE_BORDER_COLOR vec4(0.0)
#endif

/* Of filter weights: what devices have at least by custom, and what the sums of weights stay 1 with. */
#define SLUICE_FILTER_STEPS 256.0

/** One axis of a bilinear sample, in texels of a level. */
struct SluicePageAxis {
    int low, high; /* -1: beyond the border */
    float weight;  /* of `high` */
};

SluicePageAxis sluicePageAxis(float coordinate, uint addressMode, int size)
{
    float n = float(size);
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT) {
        coordinate -= floor(coordinate);
    } else if (addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
        coordinate -= 2.0 * floor(coordinate * 0.5);
        coordinate = coordinate > 1.0 ? 2.0 - coordinate : coordinate;
    } else if (addressMode == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER) {
        coordinate = clamp(coordinate, -1.0 - 1.0 / n, 2.0 + 1.0 / n);
    } else {
        if (addressMode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE)
            coordinate = abs(coordinate);
        coordinate = clamp(coordinate, 0.0, 1.0);
    }
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

ivec2 sluiceLevelSize(SluiceTextureEntry entry, uint level)
{
    return max(ivec2(uvec2(entry.width, entry.height) >> level), ivec2(1));
}

ivec2 sluiceTileShift(SluiceTextureEntry entry)
{
    return ivec2(entry.tileShift & 255u, (entry.tileShift >> 8u) & 255u);
}

/** The page of a tile of a regular level; SLUICE_PAGE_NONE where there is none. */
uint sluiceReadPage(SluiceTextureEntry entry, uint level, ivec2 tile)
{
    ivec2 shift = sluiceTileShift(entry);
    int columns = (sluiceLevelSize(entry, level).x + (1 << shift.x) - 1) >> shift.x;
    uint first = SLUICE_PAGE_TABLE_WORD(entry.pageTableOffset + level);
    return SLUICE_PAGE_TABLE_WORD(first + uint(tile.y * columns + tile.x));
}

/* Without non-uniform indexing of arrays every place is visited, and one of them sampled. */
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

/** One texel of a regular level; 0 where it is not resident. */
vec4 sluiceFetchPaged(SluiceTextureEntry entry, uint level, ivec2 texel)
{
    ivec2 shift = sluiceTileShift(entry);
    uint page = sluiceReadPage(entry, level, texel >> shift);
    vec4 color = vec4(0.0);
    if (page == SLUICE_PAGE_NONE)
        return color;
    ivec3 at = ivec3(texel & ((ivec2(1) << shift) - 1), page & 0xFFFFu);
    SLUICE_WITH_PAGE(page, color = texelFetch(SLUICE_PAGE_TEXTURE(chunk), at, 0))
    return color;
}

/** Of a border only the components count that the format has. */
vec4 sluiceBorder(SluiceTextureEntry entry)
{
    uint count = (entry.flags >> SLUICE_TEXTURE_COMPONENTS_SHIFT) & 7u;
    vec4 color = SLUICE_BORDER_COLOR;
    return vec4(color.r, count > 1u ? color.g : 0.0, count > 2u ? color.b : 0.0,
                count > 3u ? color.a : 1.0);
}

vec4 sluiceFetchOrBorder(SluiceTextureEntry entry, uint level, int x, int y)
{
    return min(x, y) < 0 ? sluiceBorder(entry) : sluiceFetchPaged(entry, level, ivec2(x, y));
}

/** Across borders of pages. A texel of no weight is not looked at: it may be infinite. */
vec4 sluiceGatherPaged(SluiceTextureEntry entry, uint level, SluicePageAxis x, SluicePageAxis y)
{
    vec4 color = sluiceFetchOrBorder(entry, level, x.low, y.low);
    if (x.weight > 0.0 && x.high != x.low)
        color = mix(color, sluiceFetchOrBorder(entry, level, x.high, y.low), x.weight);
    if (!(y.weight > 0.0) || y.high == y.low)
        return color;
    vec4 below = sluiceFetchOrBorder(entry, level, x.low, y.high);
    if (x.weight > 0.0 && x.high != x.low)
        below = mix(below, sluiceFetchOrBorder(entry, level, x.high, y.high), x.weight);
    return mix(color, below, y.weight);
}

/** A bilinear sample of a regular level. */
vec4 sluiceSamplePages(SluiceTextureEntry entry, uint level, vec2 uv)
{
    ivec2 size = sluiceLevelSize(entry, level);
    SluicePageAxis x = sluicePageAxis(uv.x, entry.addressModeU, size.x);
    SluicePageAxis y = sluicePageAxis(uv.y, entry.addressModeV, size.y);
    ivec2 low = ivec2(x.low, y.low), high = ivec2(x.high, y.high);
    ivec2 shift = sluiceTileShift(entry);
    ivec2 tile = low >> shift;
    if (any(notEqual(high, low + 1)) || any(notEqual(high >> shift, tile)) || min(low.x, low.y) < 0)
        return sluiceGatherPaged(entry, level, x, y);
    uint page = sluiceReadPage(entry, level, tile);
    vec4 color = vec4(0.0);
    if (page == SLUICE_PAGE_NONE)
        return color;
    vec2 local = vec2(low - (tile << shift)) + vec2(x.weight, y.weight) + 0.5;
    vec3 at = vec3(local / vec2(ivec2(1) << shift), float(page & 0xFFFFu));
    SLUICE_WITH_PAGE(page, color = textureLod(SLUICE_PAGE_TEXTURE(chunk), at, 0.0))
    return color;
}

/** A bilinear sample of any level; `tail` has the packed ones. */
vec4 sluiceSampleLevel(sampler2D tail, SluiceTextureEntry entry, uint level, vec2 uv)
{
    if (level >= entry.regularMipCount)
        return textureLod(tail, uv, float(level - entry.regularMipCount));
    return sluiceSamplePages(entry, level, uv);
}

/** The tail's sampler reckons with the tail's own size: of derivatives. */
vec2 sluiceTailScale(SluiceTextureEntry entry)
{
    return vec2(entry.width, entry.height) / (vec2(sluiceLevelSize(entry, entry.regularMipCount)) *
                                              exp2(float(entry.regularMipCount)));
}

vec4 sluiceSampleTail(sampler2D tail, SluiceTextureEntry entry, vec2 uv, vec2 dx, vec2 dy)
{
    vec2 scale = sluiceTailScale(entry);
    return textureGrad(tail, uv, dx * scale, dy * scale);
}

/** What a trilinear or anisotropic sample is made of: bilinear ones in a row, each of two levels. */
struct SluicePagedTaps {
    uint fine, coarse; /* levels */
    float fraction;    /* of `coarse`: 0 to 1 */
    uint count;
    vec2 axis; /* of the row, in uv */
};

float sluiceClampPagedLod(SluiceTextureEntry entry, float lod)
{
    return clamp(lod, 0.0, float(entry.mipLevelCount - 1u));
}

/**
 * At `lod`, clamped, with derivatives that hold all bias. Of the anisotropic ones as many samples
 * along the longer derivative as that is longer than a pixel of the level: the customary way, which
 * every device refines in its own.
 */
SluicePagedTaps sluicePlacePagedTaps(SluiceTextureEntry entry, vec2 dx, vec2 dy, float lod,
                                     float maxAnisotropy)
{
    SluicePagedTaps taps;
    taps.fine = uint(lod);
    taps.coarse = min(taps.fine + 1u, entry.mipLevelCount - 1u);
    taps.fraction =
        floor((lod - float(taps.fine)) * SLUICE_FILTER_STEPS + 0.5) / SLUICE_FILTER_STEPS;
    taps.count = 1u;
    taps.axis = vec2(0.0);
    if (maxAnisotropy > 1.0) {
        vec2 size = vec2(entry.width, entry.height);
        float x = length(dx * size), y = length(dy * size);
        taps.axis = x >= y ? dx : dy;
        float ratio = max(x, y) / exp2(lod);
        taps.count = uint(clamp(ceil(ratio - 0.01), 1.0, sluiceClampAnisotropy(maxAnisotropy)));
    }
    return taps;
}

vec2 sluicePagedTap(SluicePagedTaps taps, vec2 uv, uint i)
{
    return uv + taps.axis * ((float(i) + 0.5) / float(taps.count) - 0.5);
}

/** A level of no weight is not looked at: it may be infinite. */
vec4 sluiceMixLevels(SluicePagedTaps taps, vec4 fine, vec4 coarse)
{
    if (taps.fraction >= 1.0)
        return coarse;
    return taps.fraction > 0.0 ? mix(fine, coarse, taps.fraction) : fine;
}

/** What a trilinear or anisotropic sampler does at `lod` with derivatives that hold all bias. */
vec4 sluiceSamplePaged(sampler2D tail, SluiceTextureEntry entry, vec2 uv, vec2 dx, vec2 dy,
                       float lod, float maxAnisotropy)
{
    lod = sluiceClampPagedLod(entry, lod);
    if (lod >= float(entry.regularMipCount))
        return sluiceSampleTail(tail, entry, uv, dx, dy);
    SluicePagedTaps taps = sluicePlacePagedTaps(entry, dx, dy, lod, maxAnisotropy);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < taps.count; i++) {
        vec2 at = sluicePagedTap(taps, uv, i);
        vec4 fine = vec4(0.0), coarse = vec4(0.0);
        if (taps.fraction < 1.0)
            fine = sluiceSampleLevel(tail, entry, taps.fine, at);
        if (taps.fraction > 0.0)
            coarse = sluiceSampleLevel(tail, entry, taps.coarse, at);
        sum += sluiceMixLevels(taps, fine, coarse);
    }
    return sum / float(taps.count);
}

/** 1 if a texel of a bilinear sample has no page. */
uint sluiceCountUnpaged(SluiceTextureEntry entry, uint level, vec2 uv)
{
    if (level >= entry.regularMipCount)
        return 0u;
    ivec2 size = sluiceLevelSize(entry, level);
    SluicePageAxis x = sluicePageAxis(uv.x, entry.addressModeU, size.x);
    SluicePageAxis y = sluicePageAxis(uv.y, entry.addressModeV, size.y);
    ivec2 shift = sluiceTileShift(entry);
    for (uint i = 0u; i < 4u; i++) {
        ivec2 texel = ivec2((i & 1u) == 0u ? x.low : x.high, (i & 2u) == 0u ? y.low : y.high);
        if (min(texel.x, texel.y) >= 0 &&
            sluiceReadPage(entry, level, texel >> shift) == SLUICE_PAGE_NONE)
            return 1u;
    }
    return 0u;
}

#endif
