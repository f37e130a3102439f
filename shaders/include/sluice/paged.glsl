/*
 * Samples textures whose tiles are pages: layers of array images, found through the page table.
 *
 * A bilinear sample whose four texels lie in one page is one hardware sample of that layer. If it
 * crosses the border of a page, or wraps around the texture, its texels are fetched one by one and
 * weighted like hardware does, in steps of 1/256 texel. So pages need no gutters, and any filter
 * width is correct. Packed levels are sampled from the texture's own image, with its sampler.
 *
 * Only sample.glsl and residency.glsl include this file, if SLUICE_PAGED is defined (buffers.glsl).
 * sample_textures.glsl has the functions that take a texture.
 */
#ifndef SLUICE_PAGED_GLSL
#define SLUICE_PAGED_GLSL

#include "buffers.glsl"
#include "lod.glsl"
#include "page_filter.glsl"

ivec2 sluiceLevelSize(SluiceTextureEntry entry, uint level)
{
    return max(ivec2(uvec2(entry.width, entry.height) >> level), SLUICE_SPLAT(ivec2, 1));
}

ivec2 sluiceTileShift(SluiceTextureEntry entry)
{
    return ivec2(entry.tileShift & 255u, (entry.tileShift >> 8u) & 255u);
}

/** Returns the page of a tile of a regular level. SLUICE_PAGE_NONE if it has none. */
uint sluiceReadPage(SluiceTextureEntry entry, uint level, ivec2 tile)
{
    ivec2 shift = sluiceTileShift(entry);
    int columns = (sluiceLevelSize(entry, level).x + (1 << shift.x) - 1) >> shift.x;
    uint first = SLUICE_PAGE_TABLE_WORD(entry.pageTableOffset + level);
    return SLUICE_PAGE_TABLE_WORD(first + uint(tile.y * columns + tile.x));
}

/** Fetches one texel of a regular level. 0 if it is not resident. */
vec4 sluiceFetchPaged(SluiceTextureEntry entry, uint level, ivec2 texel)
{
    ivec2 shift = sluiceTileShift(entry);
    uint page = sluiceReadPage(entry, level, texel >> shift);
    vec4 color = SLUICE_SPLAT(vec4, 0.0);
    if (page == SLUICE_PAGE_NONE)
        return color;
    ivec3 at = ivec3(texel & ((SLUICE_SPLAT(ivec2, 1) << shift) - 1), page & 0xFFFFu);
    SLUICE_WITH_PAGE(page, color = SLUICE_ARRAY_FETCH(SLUICE_PAGE_TEXTURE(chunk), at))
    return color;
}

/** Looks up the page of a texel. SLUICE_PAGE_NONE for a texel beyond the border. */
uint sluiceFindTexelPage(SluiceTextureEntry entry, uint level, int x, int y)
{
    uint page = SLUICE_PAGE_NONE;
    if (min(x, y) >= 0)
        page = sluiceReadPage(entry, level, ivec2(x, y) >> sluiceTileShift(entry));
    return page;
}

/** Fetches a texel of `page`. 0 if it is not resident. */
vec4 sluiceFetchOrBorder(SluiceTextureEntry entry, uint page, int x, int y)
{
    vec4 color = SLUICE_SPLAT(vec4, 0.0);
    if (min(x, y) < 0)
        return sluiceBorder(entry);
    if (page == SLUICE_PAGE_NONE)
        return color;
    ivec3 at = ivec3(ivec2(x, y) & ((SLUICE_SPLAT(ivec2, 1) << sluiceTileShift(entry)) - 1), page & 0xFFFFu);
    SLUICE_WITH_PAGE(page, color = SLUICE_ARRAY_FETCH(SLUICE_PAGE_TEXTURE(chunk), at))
    return color;
}

/**
 * Samples across borders of pages. Texels of weight 0 are not read, because they may be infinite. Pages
 * are looked up before texels are fetched, because loads take long.
 */
vec4 sluiceGatherPaged(SluiceTextureEntry entry, uint level, SluicePageAxis x, SluicePageAxis y)
{
    int right = x.weight > 0.0 ? x.high : x.low, below = y.weight > 0.0 ? y.high : y.low;
    uint pages[4];
    pages[0] = sluiceFindTexelPage(entry, level, x.low, y.low);
    pages[1] = sluiceFindTexelPage(entry, level, right, y.low);
    pages[2] = sluiceFindTexelPage(entry, level, x.low, below);
    pages[3] = sluiceFindTexelPage(entry, level, right, below);
    vec4 upper = sluiceFetchOrBorder(entry, pages[0], x.low, y.low);
    vec4 upperRight = sluiceFetchOrBorder(entry, pages[1], right, y.low);
    vec4 lower = sluiceFetchOrBorder(entry, pages[2], x.low, below);
    vec4 lowerRight = sluiceFetchOrBorder(entry, pages[3], right, below);
    if (right != x.low) {
        upper = mix(upper, upperRight, x.weight);
        lower = mix(lower, lowerRight, x.weight);
    }
    return below != y.low ? mix(upper, lower, y.weight) : upper;
}

/** Returns a bilinear sample of a regular level. */
vec4 sluiceSamplePages(SluiceTextureEntry entry, uint level, vec2 uv)
{
    ivec2 size = sluiceLevelSize(entry, level);
    bool repeatsU = (entry.shape >> SLUICE_SHAPE_MODE_U_SHIFT & 7u) == SLUICE_ADDRESS_MODE_REPEAT;
    bool repeatsV = (entry.shape >> SLUICE_SHAPE_MODE_V_SHIFT & 7u) == SLUICE_ADDRESS_MODE_REPEAT;
    vec2 folded = uv - vec2(repeatsU ? floor(uv.x) : 0.0, repeatsV ? floor(uv.y) : 0.0);
    SluicePagePlace place = sluicePlaceInTile(folded, vec2(size), sluiceTileShare(sluiceTileShift(entry)));
    if (!place.inside)
        return sluiceGatherPaged(entry, level, sluicePageAxis(uv.x, entry.addressModeU, size.x),
                                 sluicePageAxis(uv.y, entry.addressModeV, size.y));
    uint page = sluiceReadPage(entry, level, ivec2(place.tile));
    vec4 color = SLUICE_SPLAT(vec4, 0.0);
    if (page == SLUICE_PAGE_NONE)
        return color;
    vec3 at = vec3(place.local, float(page & 0xFFFFu));
    SLUICE_WITH_PAGE(page, color = SLUICE_ARRAY_SAMPLE(SLUICE_PAGE_TEXTURE(chunk), SLUICE_PAGE_SAMPLER(chunk), at))
    return color;
}

/**
 * Returns the scale of derivatives for the packed levels' image, whose sampler uses its own size.
 */
vec2 sluiceTailScale(SluiceTextureEntry entry)
{
    return vec2(entry.width, entry.height) / (vec2(sluiceLevelSize(entry, entry.regularMipCount)) *
                                              exp2(float(entry.regularMipCount)));
}

float sluiceClampPagedLod(SluiceTextureEntry entry, float lod)
{
    return clamp(lod, 0.0, float(entry.mipLevelCount - 1u));
}

SluicePagedTaps sluicePlacePagedTaps(SluiceTextureEntry entry, vec2 dx, vec2 dy, float lod,
                                     float maxAnisotropy)
{
    return sluicePlaceTaps(vec2(entry.width, entry.height), entry.mipLevelCount, dx, dy, lod,
                           sluiceClampAnisotropy(maxAnisotropy));
}

vec2 sluicePagedTap(SluicePagedTaps taps, vec2 uv, uint i)
{
    return uv + taps.axis * ((float(i) + 0.5) / float(taps.count) - 0.5);
}

/** Mixes two levels. A level of weight 0 is not used, because it may be infinite. */
vec4 sluiceMixLevels(SluicePagedTaps taps, vec4 fine, vec4 coarse)
{
    if (taps.fraction >= 1.0)
        return coarse;
    return taps.fraction > 0.0 ? mix(fine, coarse, taps.fraction) : fine;
}

/** Returns 1 if a texel of a bilinear sample has no page, else 0. */
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
