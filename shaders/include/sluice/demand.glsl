/*
 * Samples textures that are loaded on demand: returns a colour, and whether all that it is made of was
 * resident. What was not has been asked for, all of it in one invocation, and is there in a later
 * launch. No texel is touched that is not resident. C interface: sluice/demand.h.
 *
 *     bool resident;
 *     vec4 color = sluiceDemandGrad(index, uv, dx, dy, resident);
 *     if (!resident) // keep the ray, and trace it again in the next launch
 *
 * `index`, of a texture or a grid, are the low 32 bits of a SluiceDemandTextureId; it may differ from
 * invocation to invocation. Everything is compiled where it is called, and is long: call one function,
 * in one place. All functions may be called in any stage and anywhere in it: they take no
 * derivatives. Address modes, filters, anisotropy and LOD bias are the texture's; the bias of the
 * loader, while memory is short, is added. Without a reason to be resident or not:
 *
 *     a texture that nobody has opened      (0, 0, 0, 0), not resident; asks for it to be opened
 *     one that cannot be opened             its failureColor, resident
 *     LOD at or beyond the last level       the colour of the last level; no page is looked up
 *     derivatives that are infinite or NaN  the same
 *     a LOD that is NaN                     the same
 *     uv not finite, or beyond 1e33         as at (0, 0)
 *     a tile that will never be there       the next coarser level instead, resident
 *
 * Grids: texture floor(uv) of the grid at uv - floor(uv), clamped to its edge, whatever its address
 * modes are. Derivatives are those of uv, so in units of one texture.
 *
 * What an includer must define before, besides what demand_pages.glsl wants:
 *
 *     #define SLUICE_DEMAND_TEXTURE(i) textures.entries[i]     // SluiceDemandTexture, read
 *     #define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]   // sampler2DArray: sluiceGetDemandPages
 *
 * and SLUICE_PAGE_LOOP where arrays cannot be indexed so, see buffers.glsl. With
 *
 *     #define SLUICE_DEMAND_PREVIEW true                       // or a constant_id constant
 *
 * what is missing is replaced by the finest coarser level that is there, or by the colour of the
 * last level: samples still say that they are not resident, and ask for what they miss.
 */
#ifndef SLUICE_DEMAND_GLSL
#define SLUICE_DEMAND_GLSL

#include "demand_pages.glsl"
#include "lod.glsl"
#include "page_filter.glsl"

#ifndef SLUICE_DEMAND_PREVIEW
#define SLUICE_DEMAND_PREVIEW false
#endif

#define SLUICE_DEMAND_MAX_ANISOTROPY 64.0

/* Coarser than any level, but finite. */
#define SLUICE_DEMAND_NO_LOD 256.0

/** What a sample knows: a texture that is open, without colours, and what it has met. */
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

/** log2 of a tile's width and height. */
ivec2 sluiceDemandTileShift(uint shape)
{
    return ivec2(bitfieldExtract(shape, 0, 5),
                 bitfieldExtract(shape, SLUICE_DEMAND_TILE_HEIGHT_SHIFT, 5));
}

/**
 * Where level `k` of a tail begins, in texels; 0 is the first level without tiles of its own. C twin:
 * slc_demand_tail_place.
 */
ivec2 sluiceDemandTailPlace(uint shape, uint k)
{
    ivec2 shift = sluiceDemandTileShift(shape) - 1; /* of half a tile */
    int middle = 1 << shift.y, level = int(k);
    int y = middle - (middle >> max(level - 1, 0));
    if ((shape & SLUICE_DEMAND_BLOCKS) != 0u && level > shift.y - 2)
        y = middle + 4 * (level - (shift.y - 1));
    return level == 0 ? ivec2(0) : ivec2(1 << shift.x, y);
}

vec4 sluiceDemandBaseColor(uint index)
{
    return vec4(SLUICE_DEMAND_TEXTURE(index).baseColor[0], SLUICE_DEMAND_TEXTURE(index).baseColor[1],
                SLUICE_DEMAND_TEXTURE(index).baseColor[2], SLUICE_DEMAND_TEXTURE(index).baseColor[3]);
}

/** Of a border only the components count that the format has. */
vec4 sluiceDemandBorder(SluiceDemandState s)
{
    uint count = bitfieldExtract(s.shape, SLUICE_DEMAND_COMPONENTS_SHIFT, 3);
    return vec4(SLUICE_DEMAND_TEXTURE(s.index).borderColor[0],
                count > 1u ? SLUICE_DEMAND_TEXTURE(s.index).borderColor[1] : 0.0,
                count > 2u ? SLUICE_DEMAND_TEXTURE(s.index).borderColor[2] : 0.0,
                count > 3u ? SLUICE_DEMAND_TEXTURE(s.index).borderColor[3] : 1.0);
}

/** The word of a tile's page; if that is SLUICE_PAGE_NONE and `ask`, it has been asked for. */
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

/** The tiles of a level. Those of the tail begin at `origin` of the one that they share. */
struct SluiceDemandLevel {
    ivec2 size, origin;
    uint firstPage;
    int columns;
};

SluiceDemandLevel sluiceReadDemandLevel(SluiceDemandState s, uint level)
{
    int shift = sluiceDemandTileShift(s.shape).x;
    uint regular = sluiceDemandRegularCount(s.shape);
    SluiceDemandLevel l;
    l.size = max(ivec2(s.size >> level), ivec2(1));
    l.columns = (l.size.x + (1 << shift) - 1) >> shift;
    if (level < regular) {
        l.firstPage = SLUICE_DEMAND_LEVEL_WORD(s.levels + level);
        l.origin = ivec2(0);
    } else {
        l.firstPage = s.tailPage;
        l.origin = sluiceDemandTailPlace(s.shape, level - regular);
    }
    return l;
}

/**
 * The four texels of a bilinear sample one by one: across borders of tiles and of the texture. All are
 * looked up, whatever is missing; `worst` is the greatest of their words. A texel of no weight is not
 * looked at.
 */
vec4 sluiceGatherDemand(inout SluiceDemandState s, SluiceDemandLevel l, bool last, SluicePageAxis x,
                        SluicePageAxis y, bool ask, out uint worst)
{
    ivec2 shift = sluiceDemandTileShift(s.shape);
    vec4 sum = vec4(0.0);
    worst = 0u;
    for (uint i = 0u; i < 4u; i++) {
        bool right = (i & 1u) != 0u, below = (i & 2u) != 0u;
        ivec2 texel = ivec2(right ? x.high : x.low, below ? y.high : y.low);
        float weight = (right ? x.weight : 1.0 - x.weight) * (below ? y.weight : 1.0 - y.weight);
        if (!(weight > 0.0))
            continue;
        vec4 color = vec4(0.0);
        if (min(texel.x, texel.y) < 0) {
            color = sluiceDemandBorder(s);
        } else if (last) {
            color = sluiceDemandBaseColor(s.index);
        } else {
            ivec2 tile = texel >> shift;
            uint word = sluiceFindDemandTile(s, l.firstPage + uint(tile.y * l.columns + tile.x), ask);
            worst = max(worst, word);
            ivec3 at = ivec3(texel - (tile << shift) + l.origin, word & 0xFFFFu);
            if (word < SLUICE_DEMAND_PAGE_REFUSED)
                SLUICE_WITH_PAGE(word, color = texelFetch(SLUICE_PAGE_TEXTURE(chunk), at, 0))
        }
        sum += weight * color;
    }
    return sum;
}

/** Two texels that are one have no weight to share. */
SluicePageAxis sluiceDemandAxis(float coordinate, uint addressMode, int size, bool nearest)
{
    coordinate = sluiceFoldOntoPages(coordinate, addressMode, float(size));
    if (nearest)
        return sluiceNearestPageAxis(coordinate, addressMode, size);
    SluicePageAxis axis = sluiceFoldedPageAxis(coordinate, addressMode, size);
    axis.weight = axis.high == axis.low ? 0.0 : axis.weight;
    return axis;
}

/** A bilinear sample of one level; a colour only if `worst` is below SLUICE_DEMAND_PAGE_REFUSED. */
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
    vec2 local = vec2(low - (tile << shift) + l.origin) + vec2(x.weight, y.weight) + 0.5;
    vec3 at = vec3(local / vec2(ivec2(1) << shift), float(worst & 0xFFFFu));
    vec4 color = vec4(0.0);
    if (worst < SLUICE_DEMAND_PAGE_REFUSED)
        SLUICE_WITH_PAGE(worst, color = textureLod(SLUICE_PAGE_TEXTURE(chunk), at, 0.0))
    return color;
}

/**
 * The same, or of a coarser level: where tiles will never be there, and in a preview where they are
 * missing. Coarser levels that only stand in are not asked for, but for the tail, which serves all.
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
                return vec4(0.0);
            ask = false;
        }
        /* the last level is always there: a colour of the texture */
        level = level < regular ? level + 1u : sluiceDemandLastLevel(s.shape);
    }
}

/** A coordinate near the texture that shows the same; only whole periods are taken away. */
float sluiceNearCoordinate(float coordinate, uint addressMode)
{
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT || addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT)
        return coordinate - 2.0 * floor(coordinate * 0.5);
    return coordinate;
}

/** The first weights of a cubic B-spline, of texels -1 and 0; `t` from texel 0 to 1. */
vec2 sluiceSplineWeights(float t)
{
    float back = 1.0 - t;
    return vec2(back * back * back, 3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0;
}

/** One axis of a bicubic sample: half of it (the first or the other) is a linear one, at x, that has
 *  the weight y. */
vec2 sluiceSplineHalf(float coordinate, float n, bool second)
{
    float at = clamp(coordinate, -1.0e9, 1.0e9) * n - 0.5; /* beyond, nothing changes */
    float low = floor(at), t = at - low;
    vec2 w = second ? sluiceSplineWeights(1.0 - t).yx : sluiceSplineWeights(t);
    float sum = w.x + w.y;
    return vec2((low + (second ? 1.5 : -0.5) + w.y / sum) / n, sum);
}

/** Part 0 to 3 of a bicubic sample of level 0 is a bilinear one; returns where, and `weight` times
 *  its own. */
vec2 sluiceCubicPart(SluiceDemandState s, vec2 uv, uint part, inout float weight)
{
    vec2 x = sluiceSplineHalf(uv.x, float(s.size.x), (part & 1u) != 0u);
    vec2 y = sluiceSplineHalf(uv.y, float(s.size.y), (part & 2u) != 0u);
    weight *= x.y * y.y;
    return vec2(x.x, y.x);
}

/** All bilinear samples of one sample. Bicubic ones are of level 0 alone. */
vec4 sluiceSumDemand(inout SluiceDemandState s, SluicePagedTaps taps, vec2 uv, bool cubic)
{
    vec4 sum = vec4(0.0);
    for (uint pass = 0u; pass < 2u; pass++) {
        float share = pass == 0u ? 1.0 - taps.fraction : taps.fraction;
        if (!(share > 0.0))
            continue;
        uint level = pass == 0u ? taps.fine : taps.coarse;
        uint parts = cubic && level == 0u ? 2u : 0u; /* log2 */
        for (uint i = 0u; i < taps.count << parts; i++) {
            vec2 at = sluicePagedTap(taps, uv, i >> parts);
            float weight = share;
            if (parts != 0u)
                at = sluiceCubicPart(s, at, i & 3u, weight);
            sum += weight * sluiceDemandTexels(s, level, at);
        }
    }
    return sum / float(taps.count);
}

/** Finds a texture in a grid; false: there is none at `uv`. */
bool sluiceFindInGrid(inout uint index, inout vec2 uv)
{
    uvec2 size = uvec2(SLUICE_DEMAND_TEXTURE(index).width, SLUICE_DEMAND_TEXTURE(index).height);
    vec2 cell = floor(uv);
    if (any(lessThan(cell, vec2(0.0))) || any(greaterThanEqual(cell, vec2(size))))
        return false;
    uint member = SLUICE_DEMAND_LEVEL_WORD(SLUICE_DEMAND_TEXTURE(index).levels +
                                           uint(cell.y) * size.x + uint(cell.x));
    if (member == SLUICE_DEMAND_NO_TEXTURE)
        return false;
    index = member;
    uv -= cell;
    return true;
}

/** Whether the texture is open, and has pages; else `color` is its sample. */
bool sluiceOpenDemand(uint index, inout vec2 uv, out SluiceDemandState s, out vec4 color)
{
    s.resident = true;
    uint state = SLUICE_DEMAND_TEXTURE(index).state;
    bool grid = state == SLUICE_DEMAND_TEXTURE_UDIM;
    uv = sluiceIsFinite(uv) ? uv : vec2(0.0);
    if (grid && sluiceFindInGrid(index, uv))
        state = SLUICE_DEMAND_TEXTURE(index).state;
    color = vec4(0.0);
    if (state != SLUICE_DEMAND_TEXTURE_OPEN) {
        s.resident = state != SLUICE_DEMAND_TEXTURE_UNKNOWN;
        if (s.resident)
            color = sluiceDemandBaseColor(index);
        else
            sluiceRequestDemandPage(index);
        return false;
    }
    s.index = index;
    s.size = uvec2(SLUICE_DEMAND_TEXTURE(index).width, SLUICE_DEMAND_TEXTURE(index).height);
    s.shape = SLUICE_DEMAND_TEXTURE(index).shape;
    s.levels = SLUICE_DEMAND_TEXTURE(index).levels;
    s.tailPage = SLUICE_DEMAND_TEXTURE(index).tailPage;
    if (grid) {
        s.shape = bitfieldInsert(s.shape, SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE, SLUICE_DEMAND_MODE_U_SHIFT, 3);
        s.shape = bitfieldInsert(s.shape, SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE, SLUICE_DEMAND_MODE_V_SHIFT, 3);
    }
    s.page = SLUICE_PAGE_NONE;
    s.word = SLUICE_PAGE_NONE;
    return true;
}

float sluiceDemandLodBias(uint index)
{
    return SLUICE_DEMAND_TEXTURE(index).lodBias +
           uintBitsToFloat(SLUICE_DEMAND_LEVEL_WORD(SLUICE_DEMAND_PARAMETER_LOD_BIAS));
}

/** At `lod`, bias included, with derivatives that hold all bias and up to `maxTaps` in a row. */
vec4 sluiceSampleDemand(inout SluiceDemandState s, vec2 uv, vec2 dx, vec2 dy, float lod,
                        float maxTaps, bool cubic)
{
    uint last = sluiceDemandLastLevel(s.shape);
    uvec2 modes = sluiceDemandModes(s.shape);
    bool beyond = !(lod < float(last)); /* NaN */
    if (beyond && modes.x != SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER &&
        modes.y != SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER)
        return sluiceDemandBaseColor(s.index);
    lod = beyond ? float(last) : max(lod, 0.0);
    SluicePagedTaps taps =
        sluicePlaceTaps(vec2(s.size), last + 1u, dx, dy, lod, beyond ? 1.0 : maxTaps);
    if ((s.shape & SLUICE_DEMAND_NEAREST_LEVEL) != 0u) {
        taps.fine = uint(max(ceil(lod - 0.5), 0.0));
        taps.fraction = 0.0;
    }
    if (taps.count > 1u || cubic) /* steps of a row are small beside some coordinates */
        uv = vec2(sluiceNearCoordinate(uv.x, modes.x), sluiceNearCoordinate(uv.y, modes.y));
    if (cubic)
        s.shape &= ~SLUICE_DEMAND_NEAREST;
    vec4 color = sluiceSumDemand(s, taps, uv, cubic);
    return s.resident || SLUICE_DEMAND_PREVIEW ? color : vec4(0.0);
}

/**
 * The LOD of a sample with derivatives in texels of level 0, without bias: log2 of the shorter axis
 * of the ellipse that they span, or of the longer derivative divided by `maxAnisotropy`, whichever is
 * longer. Exact to 1e-4 for all derivatives whose sum is a normal number; SLUICE_DEMAND_NO_LOD for
 * those that are infinite or NaN.
 */
float sluiceDemandComputeLod(vec2 dx, vec2 dy, float maxAnisotropy)
{
    float sum = abs(dx.x) + abs(dx.y) + abs(dy.x) + abs(dy.y);
    if (!(sum <= 3.0e38))
        return SLUICE_DEMAND_NO_LOD;
    /* Scaled to 1 to 2 by a power of two, so that squares of squares stay in range. */
    int exponent = clamp(int(floatBitsToUint(sum) >> 23u), 1, 253) - 127;
    float scale = uintBitsToFloat(uint(127 - exponent) << 23u);
    dx *= scale;
    dy *= scale;
    float x2 = dot(dx, dx), y2 = dot(dy, dy);
    float minor2 = max(x2, y2);
    if (maxAnisotropy > 1.0) {
        float area = dx.x * dy.y - dx.y * dy.x;
        float wide2 = 0.5 * (x2 + y2 + length(vec2(x2 - y2, 2.0 * dot(dx, dy))));
        minor2 = max(area * area / max(wide2, 1.0e-6), minor2 / (maxAnisotropy * maxAnisotropy));
    }
    return 0.5 * log2(max(minor2, 1.0e-12)) + float(exponent);
}

/** All ways to sample in one: at `lod`, or at that of the derivatives. */
vec4 sluiceDemandSample(uint index, vec2 uv, vec2 dx, vec2 dy, bool atLod, float lod, bool cubic,
                        out bool resident)
{
    SluiceDemandState s;
    vec4 color;
    if (sluiceOpenDemand(index, uv, s, color)) {
        vec2 size = vec2(s.size);
        float bias = sluiceDemandLodBias(s.index), scale = exp2(bias), n = 1.0;
        if (!atLod) {
            n = clamp(SLUICE_DEMAND_TEXTURE(s.index).maxAnisotropy, 1.0, SLUICE_DEMAND_MAX_ANISOTROPY);
            lod = sluiceDemandComputeLod(dx * size, dy * size, n);
        }
        color = sluiceSampleDemand(s, uv, dx * scale, dy * scale, lod + bias, n, cubic);
    }
    resident = s.resident;
    return color;
}

/** With derivatives of `uv` per pixel, as textureGrad: trilinear, or anisotropic. */
vec4 sluiceDemandGrad(uint index, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    return sluiceDemandSample(index, uv, dx, dy, false, 0.0, false, resident);
}

/**
 * As sluiceDemandGrad, but where the texture is magnified it is filtered by a bicubic B-spline, which
 * is smooth and does not go through the texels. Up to level 1 it becomes trilinear bit by bit, and
 * is so from there on. The texture's filter inside a level does not count.
 */
vec4 sluiceDemandCubic(uint index, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    return sluiceDemandSample(index, uv, dx, dy, false, 0.0, true, resident);
}

/** At a level of detail, to which both biases are added, as textureLod: without anisotropy. */
vec4 sluiceDemandLod(uint index, vec2 uv, float lod, out bool resident)
{
    return sluiceDemandSample(index, uv, vec2(0.0), vec2(0.0), true, lod, false, resident);
}

#endif
