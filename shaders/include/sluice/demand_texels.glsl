/*
 * Takes one bilinear sample of one level of a texture that is loaded on demand. The part of
 * demand.glsl that reads pages; only demand.glsl and demand_filters.glsl include it.
 */
#ifndef SLUICE_DEMAND_TEXELS_GLSL
#define SLUICE_DEMAND_TEXELS_GLSL

#include "demand_pages.glsl"
#ifndef SLUICE_HLSL /* unrolled, the long paths would be three times as long; they are rarely taken */
#extension GL_EXT_control_flow_attributes : require
#endif
#include "page_filter.glsl"

/* Shaders that only load on demand may define SLUICE_PAGE_TEXTURE alone. */
#ifndef SLUICE_DEMAND_PAGE_TEXTURE
#define SLUICE_DEMAND_PAGE_TEXTURE(i) SLUICE_PAGE_TEXTURE(i)
#define SLUICE_DEMAND_PAGE_SAMPLER(i) SLUICE_PAGE_SAMPLER(i)
#endif

#ifndef SLUICE_DEMAND_PREVIEW
#define SLUICE_DEMAND_PREVIEW false
#endif

/** State of a sample: the open texture without its colors, and the result so far. */
struct SluiceDemandState {
    uint index;
    uvec2 size;
    uint shape, levels, tailPage;
    bool resident;
    uint page, word; /* looked up last: its word, see SLUICE_PAGE_NONE and _REFUSED */
};

uint sluiceDemandLastLevel(uint shape)
{
    return bitfieldExtract(shape, SLUICE_DEMAND_LEVEL_COUNT_SHIFT, 5) - 1u;
}

uint sluiceDemandRegularCount(uint shape)
{
    return bitfieldExtract(shape, SLUICE_DEMAND_REGULAR_SHIFT, 5);
}

uvec2 sluiceDemandModes(uint shape)
{
    return uvec2(bitfieldExtract(shape, SLUICE_DEMAND_MODE_U_SHIFT, 3),
                 bitfieldExtract(shape, SLUICE_DEMAND_MODE_V_SHIFT, 3));
}

/** Returns log2 of a tile's width and height. */
ivec2 sluiceDemandTileShift(uint shape)
{
    return ivec2(bitfieldExtract(shape, 0, 4),
                 bitfieldExtract(shape, SLUICE_DEMAND_TILE_HEIGHT_SHIFT, 4));
}

/**
 * Returns where level `k` of a mip tail begins in its page, in texels. `word` is the page's word. 0
 * is the first level without tiles of its own. C twin: slc_demand_tail_place.
 */
ivec2 sluiceDemandTailPlace(uint shape, uint word, uint k)
{
    ivec2 cell = SLUICE_SPLAT(ivec2, 1) << sluiceDemandTileShift(shape);
    uint n = bitfieldExtract(word, SLUICE_DEMAND_CELL_SHIFT, 2);
    if (n != 0u)
        cell = SLUICE_SPLAT(ivec2, SLUICE_DEMAND_CELL_SIDE(cell.y, n));
    int slot = int(bitfieldExtract(word, SLUICE_DEMAND_SLOT_SHIFT, 2)) - 1;
    int block = (shape & SLUICE_DEMAND_BLOCKS) != 0u ? 4 : 1, level = int(k);
    ivec2 corner = cell * ivec2(bitfieldExtract(word, SLUICE_DEMAND_CELL_X_SHIFT, 3),
                                bitfieldExtract(word, SLUICE_DEMAND_CELL_Y_SHIFT, 2));
    ivec2 quarter = cell >> (level + 1);
    if (quarter.y >= block)
        return corner + cell - (cell >> level) + ivec2(slot & 1, slot >> 1) * quarter;
    int cuts = findMSB(cell.y / block);
    return corner + ivec2((4 * slot + level - cuts) * block, cell.y >> 1);
}

vec4 sluiceDemandBaseColor(uint index)
{
    return vec4(SLUICE_DEMAND_TEXTURE(index).baseColor[0], SLUICE_DEMAND_TEXTURE(index).baseColor[1],
                SLUICE_DEMAND_TEXTURE(index).baseColor[2], SLUICE_DEMAND_TEXTURE(index).baseColor[3]);
}

/** Returns the border color, limited to the components of the format. */
vec4 sluiceDemandBorder(SluiceDemandState s)
{
    uint count = bitfieldExtract(s.shape, SLUICE_DEMAND_COMPONENTS_SHIFT, 3);
    return vec4(SLUICE_DEMAND_TEXTURE(s.index).borderColor[0],
                count > 1u ? SLUICE_DEMAND_TEXTURE(s.index).borderColor[1] : 0.0,
                count > 2u ? SLUICE_DEMAND_TEXTURE(s.index).borderColor[2] : 0.0,
                count > 3u ? SLUICE_DEMAND_TEXTURE(s.index).borderColor[3] : 1.0);
}

/**
 * Returns the word of a tile's page. If it is SLUICE_PAGE_NONE and `ask` is true, the page is
 * requested.
 */
uint sluiceFindDemandTile(inout SluiceDemandState s, uint page, bool ask)
{
    if (page == s.page)
        return s.word;
    uint at, word;
    if (!sluiceFindDemandPage(page, at, word))
        word = SLUICE_PAGE_NONE;
    if (word == SLUICE_PAGE_NONE) {
        if (!ask)
            return word;
        sluiceRequestDemandPage(page);
    }
    s.page = page;
    s.word = word;
    return word;
}

/** Tiles of a level. */
struct SluiceDemandLevel {
    ivec2 size;
    uint firstPage;
    int columns;
    int tail; /* level of the mip tail; below 0: the level has tiles */
};

/** Returns where the level begins in the page of `word`. */
ivec2 sluiceDemandOrigin(uint shape, SluiceDemandLevel l, uint word)
{
    return l.tail < 0 ? SLUICE_SPLAT(ivec2, 0) : sluiceDemandTailPlace(shape, word, uint(l.tail));
}

SluiceDemandLevel sluiceReadDemandLevel(SluiceDemandState s, uint level)
{
    int shift = sluiceDemandTileShift(s.shape).x;
    uint regular = sluiceDemandRegularCount(s.shape);
    SluiceDemandLevel l;
    l.size = max(ivec2(s.size >> level), SLUICE_SPLAT(ivec2, 1));
    l.columns = (l.size.x + (1 << shift) - 1) >> shift;
    l.tail = int(level) - int(regular);
    if (level < regular)
        l.firstPage = SLUICE_DEMAND_LEVEL_WORD(s.levels + level);
    else
        l.firstPage = s.tailPage;
    return l;
}

/**
 * Fetches the four texels of a bilinear sample one by one, across borders of tiles and of the
 * texture. All are looked up, even if one is missing. `worst` is the greatest of their words.
 * Texels of weight 0 are skipped.
 */
vec4 sluiceGatherDemand(inout SluiceDemandState s, SluiceDemandLevel l, bool last, SluicePageAxis x,
                        SluicePageAxis y, bool ask, out uint worst)
{
    ivec2 shift = sluiceDemandTileShift(s.shape);
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    worst = 0u;
    SLUICE_DONT_UNROLL for (uint i = 0u; i < 4u; i++) {
        bool right = (i & 1u) != 0u, below = (i & 2u) != 0u;
        ivec2 texel = ivec2(right ? x.high : x.low, below ? y.high : y.low);
        float weight = (right ? x.weight : 1.0 - x.weight) * (below ? y.weight : 1.0 - y.weight);
        if (!(weight > 0.0))
            continue;
        vec4 color = SLUICE_SPLAT(vec4, 0.0);
        if (min(texel.x, texel.y) < 0) {
            color = sluiceDemandBorder(s);
        } else if (last) {
            color = sluiceDemandBaseColor(s.index);
        } else {
            ivec2 tile = texel >> shift;
            uint word = sluiceFindDemandTile(s, l.firstPage + uint(tile.y * l.columns + tile.x), ask);
            worst = max(worst, word);
            texel += sluiceDemandOrigin(s.shape, l, word) - (tile << shift);
            uint place = word & SLUICE_DEMAND_PLACE_MASK;
            ivec3 at = ivec3(texel, place & 0xFFFFu);
            if (word < SLUICE_DEMAND_PAGE_REFUSED)
                SLUICE_WITH_PAGE(place, color = SLUICE_ARRAY_FETCH(SLUICE_DEMAND_PAGE_TEXTURE(chunk), at))
        }
        sum += weight * color;
    }
    return sum;
}

/** Returns an axis of a bilinear sample. The weight is 0 if both texels are the same. */
SluicePageAxis sluiceDemandAxis(float coordinate, uint addressMode, int size, bool nearest)
{
    coordinate = sluiceFoldOntoPages(coordinate, addressMode, float(size));
    if (nearest)
        return sluiceNearestPageAxis(coordinate, addressMode, size);
    SluicePageAxis axis = sluiceFoldedPageAxis(coordinate, addressMode, size);
    axis.weight = axis.high == axis.low ? 0.0 : axis.weight;
    return axis;
}

/**
 * Returns a bilinear sample of one level. Valid only if `worst` is below
 * SLUICE_DEMAND_PAGE_REFUSED.
 */
vec4 sluiceDemandBilinear(inout SluiceDemandState s, uint level, vec2 uv, bool ask, out uint worst)
{
    SluiceDemandLevel l = sluiceReadDemandLevel(s, level);
    uvec2 modes = sluiceDemandModes(s.shape);
    bool nearest = (s.shape & SLUICE_DEMAND_NEAREST) != 0u;
    SluicePageAxis x = sluiceDemandAxis(uv.x, modes.x, l.size.x, nearest);
    SluicePageAxis y = sluiceDemandAxis(uv.y, modes.y, l.size.y, nearest);
    ivec2 low = ivec2(x.low, y.low), high = ivec2(x.high, y.high);
    ivec2 shift = sluiceDemandTileShift(s.shape);
    ivec2 tile = low >> shift;
    if (any(notEqual(high, low + 1)) || any(notEqual(high >> shift, tile)) ||
        min(low.x, low.y) < 0)
        return sluiceGatherDemand(s, l, level == sluiceDemandLastLevel(s.shape), x, y, ask, worst);
    worst = sluiceFindDemandTile(s, l.firstPage + uint(tile.y * l.columns + tile.x), ask);
    low += sluiceDemandOrigin(s.shape, l, worst) - (tile << shift);
    vec2 local = vec2(low) + vec2(x.weight, y.weight) + 0.5;
    vec2 scale = uintBitsToFloat(uvec2(127 - shift) << 23u); /* 1 / the tile's size */
    uint place = worst & SLUICE_DEMAND_PLACE_MASK;
    vec3 at = vec3(local * scale, float(place & 0xFFFFu));
    vec4 color = SLUICE_SPLAT(vec4, 0.0);
    if (worst < SLUICE_DEMAND_PAGE_REFUSED)
        SLUICE_WITH_PAGE(place, color = SLUICE_ARRAY_SAMPLE(SLUICE_DEMAND_PAGE_TEXTURE(chunk), SLUICE_DEMAND_PAGE_SAMPLER(chunk), at))
    return color;
}

/**
 * Returns a bilinear sample of `level`, or of a coarser level: where tiles will never be resident,
 * and in a preview where they are missing. Coarser levels that only stand in are not requested,
 * except the mip tail.
 */
vec4 sluiceDemandTexels(inout SluiceDemandState s, uint level, vec2 uv)
{
    uint regular = sluiceDemandRegularCount(s.shape);
    bool ask = true;
    for (;;) {
        uint worst;
        vec4 color = sluiceDemandBilinear(s, level, uv, ask || level >= regular, worst);
        if (worst < SLUICE_DEMAND_PAGE_REFUSED)
            return color;
        if (worst == SLUICE_PAGE_NONE) {
            s.resident = false;
            if (!SLUICE_DEMAND_PREVIEW)
                return SLUICE_SPLAT(vec4, 0.0);
            ask = false;
        }
        /* the last level is always resident: a color of the texture */
        level = level < regular ? level + 1u : sluiceDemandLastLevel(s.shape);
    }
}

#endif
