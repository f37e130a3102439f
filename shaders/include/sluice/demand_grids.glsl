/*
 * Samples grids of textures that are loaded on demand (sluiceAddDemandGrid).
 *
 * Layers of an array: `index` is the index of a grid of layerCount x 1 textures; add one texture per
 * layer (SluiceDemandImage.arrayLayer). The layer may differ between invocations. Layers beyond the
 * last select the last layer, as in Vulkan. The layer's texture determines the sampler and special
 * cases (demand.glsl). An empty cell returns the grid's missingColor, resident. A texture that is not
 * a grid counts as an array of one layer.
 *
 *     bool resident;
 *     vec4 color = sluiceDemandLayerGrad(index, layer, uv, dx, dy, resident);
 *
 * UDIM sets: sampled like sluiceDemandGrad on the grid, but filtered across the edges of cells, and
 * with the grid's base texture.
 *
 *     vec4 color = sluiceDemandUdimGrad(index, uv, dx, dy, resident);
 *
 *     at the edge of two cells              each has the same weight as in one large image
 *     cells of different sizes              each at the level that has the sample's LOD; they blend
 *                                           within half a texel of the finer one
 *     LOD beyond a cell's last level        its last level, still blended with that of its neighbors
 *     edge to an empty or failed cell       clamped
 *     base texture not coarser than needed  the base texture alone; no cell is opened or read
 *     empty cell                            the base texture; without one, missingColor, resident
 *     cell that cannot be opened            its failureColor, resident
 *     outside the grid                      missingColor, resident
 *     texture that is no grid               its base color, resident
 *
 * The cell at `uv` determines anisotropy and LOD bias. Bicubic filters are linear here. Address modes
 * of cells are ignored.
 *
 * Include it after the definitions of demand.glsl, which it includes.
 */
#ifndef SLUICE_DEMAND_GRIDS_GLSL
#define SLUICE_DEMAND_GRIDS_GLSL

#include "demand.glsl"

/* Per component `b` if the condition is true, else `a`. */
#ifndef SLUICE_HLSL
#define SLUICE_SELECT(a, b, condition) mix(a, b, condition)
#elif defined(__HLSL_VERSION) && __HLSL_VERSION >= 2021
#define SLUICE_SELECT(a, b, condition) select(condition, b, a)
#else
#define SLUICE_SELECT(a, b, condition) ((condition) ? (b) : (a))
#endif

/** Replaces the index of a grid by the index of a layer's texture. False: no texture. */
bool sluiceFindDemandLayer(inout uint index, uint layer)
{
    if (SLUICE_DEMAND_TEXTURE(index).state != SLUICE_DEMAND_TEXTURE_GRID)
        return true;
    uint count = SLUICE_DEMAND_TEXTURE(index).width * SLUICE_DEMAND_TEXTURE(index).height;
    uint member =
        SLUICE_DEMAND_LEVEL_WORD(SLUICE_DEMAND_TEXTURE(index).levels + min(layer, count - 1u));
    if (member == SLUICE_DEMAND_NO_TEXTURE)
        return false;
    index = member;
    return true;
}

/** Samples a layer with derivatives of `uv` per pixel, like sluiceDemandGrad. */
vec4 sluiceDemandLayerGrad(uint index, uint layer, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    resident = true;
    if (!sluiceFindDemandLayer(index, layer))
        return sluiceDemandBaseColor(index);
    return sluiceDemandGrad(index, uv, dx, dy, resident);
}

/** Samples a layer at `lod` plus both LOD biases, like sluiceDemandLod. */
vec4 sluiceDemandLayerLod(uint index, uint layer, vec2 uv, float lod, out bool resident)
{
    resident = true;
    if (!sluiceFindDemandLayer(index, layer))
        return sluiceDemandBaseColor(index);
    return sluiceDemandLod(index, uv, lod, resident);
}

/** Returns the texture of a cell. SLUICE_DEMAND_NO_TEXTURE in empty cells and outside the grid. */
uint sluiceDemandCell(uint grid, vec2 cell)
{
    uvec2 size = uvec2(SLUICE_DEMAND_TEXTURE(grid).width, SLUICE_DEMAND_TEXTURE(grid).height);
    if (any(lessThan(cell, SLUICE_SPLAT(vec2, 0.0))) || any(greaterThanEqual(cell, vec2(size))))
        return SLUICE_DEMAND_NO_TEXTURE;
    return SLUICE_DEMAND_LEVEL_WORD(SLUICE_DEMAND_TEXTURE(grid).levels + uint(cell.y) * size.x +
                                    uint(cell.x));
}

/**
 * Returns whether a cell's texture is open. If not yet opened, requests its opening and sets
 * `resident` to false.
 */
bool sluiceIsDemandCellOpen(uint index, inout bool resident)
{
    if (index == SLUICE_DEMAND_NO_TEXTURE)
        return false;
    uint state = SLUICE_DEMAND_TEXTURE(index).state;
    if (state == SLUICE_DEMAND_TEXTURE_UNKNOWN) {
        sluiceRequestDemandPage(index);
        resident = false;
    }
    return state == SLUICE_DEMAND_TEXTURE_OPEN;
}

vec2 sluiceDemandSize(uint index)
{
    return vec2(SLUICE_DEMAND_TEXTURE(index).width, SLUICE_DEMAND_TEXTURE(index).height);
}

/** Returns the levels of a texture that would be at `lod` if it had one texel. */
SluicePagedTaps sluiceDemandLevels(uint index, float lod)
{
    vec2 size = sluiceDemandSize(index), zero = SLUICE_SPLAT(vec2, 0.0);
    uint shape = SLUICE_DEMAND_TEXTURE(index).shape, last = sluiceDemandLastLevel(shape);
    lod += log2(max(size.x, size.y));
    lod = lod < float(last) ? max(lod, 0.0) : float(last); /* NaN: last */
    SluicePagedTaps taps = sluicePlaceTaps(size, last + 1u, zero, zero, lod, 1.0);
    if ((shape & SLUICE_DEMAND_NEAREST_LEVEL) != 0u) {
        taps.fine = uint(max(ceil(lod - 0.5), 0.0));
        taps.fraction = 0.0;
    }
    taps.coarse = taps.fraction > 0.0 ? taps.coarse : taps.fine;
    return taps;
}

/** Opens a texture for texels between its edges. */
SluiceDemandState sluiceOpenDemandCell(uint index)
{
    SluiceDemandState s;
    s.index = index;
    s.size = uvec2(SLUICE_DEMAND_TEXTURE(index).width, SLUICE_DEMAND_TEXTURE(index).height);
    s.shape = SLUICE_DEMAND_TEXTURE(index).shape;
    s.levels = SLUICE_DEMAND_TEXTURE(index).levels;
    s.tailPage = SLUICE_DEMAND_TEXTURE(index).tailPage;
    s.shape = bitfieldInsert(s.shape, SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE, SLUICE_DEMAND_MODE_U_SHIFT, 3);
    s.shape = bitfieldInsert(s.shape, SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE, SLUICE_DEMAND_MODE_V_SHIFT, 3);
    s.resident = true;
    s.page = SLUICE_PAGE_NONE;
    s.word = SLUICE_PAGE_NONE;
    return s;
}

/** Returns the sizes of the fine (x) and the coarse level (y) along an axis. */
vec2 sluiceDemandExtent(uint index, SluicePagedTaps taps, uint axis)
{
    uint size = axis == 0u ? SLUICE_DEMAND_TEXTURE(index).width : SLUICE_DEMAND_TEXTURE(index).height;
    return vec2(max(uvec2(size >> taps.fine, size >> taps.coarse), SLUICE_SPLAT(uvec2, 1u)));
}

/** Weights of the next cells in x and y. */
struct SluiceDemandBeyond {
    vec2 fine, coarse; /* at each level, 0 to 1/2 */
};

/** Texture or texture grid that a sample of a UDIM grid is taken of. */
struct SluiceDemandUdim {
    uint grid, index; /* index: of the base texture, or of the cell at the middle of the sample */
    bool base;
    vec2 cell;
    float lod; /* LOD for a texture of one texel */
};

/**
 * Returns how much the next cells count at `at`, 0 to 1: within half a texel of the edge, of the
 * finer of both cells.
 */
SluiceDemandBeyond sluiceFindDemandNeighbors(SluiceDemandUdim u, uint home, vec2 cell, vec2 at,
                                             vec2 side, SluicePagedTaps taps, inout bool resident)
{
    SluiceDemandBeyond beyond;
    beyond.fine = beyond.coarse = SLUICE_SPLAT(vec2, 0.0);
    if (u.base || (SLUICE_DEMAND_TEXTURE(home).shape & SLUICE_DEMAND_NEAREST) != 0u)
        return beyond;
    SLUICE_DONT_UNROLL for (uint axis = 0u; axis < 2u; axis++) {
        vec2 step = axis == 0u ? vec2(side.x, 0.0) : vec2(0.0, side.y);
        float distance = axis == 0u ? min(at.x, 1.0 - at.x) : min(at.y, 1.0 - at.y);
        vec2 extent = sluiceDemandExtent(home, taps, axis);
        if (distance * extent.y >= 0.5) /* texels of the coarse level, which are larger */
            continue;
        uint next = sluiceDemandCell(u.grid, cell + step);
        if (sluiceIsDemandCellOpen(next, resident))
            extent = max(extent, sluiceDemandExtent(next, sluiceDemandLevels(next, u.lod), axis));
        vec2 weights = floor((0.5 - distance * extent) * SLUICE_FILTER_STEPS + 0.5) / SLUICE_FILTER_STEPS;
        weights = max(weights, 0.0);
        beyond.fine += abs(step) * weights.x;
        beyond.coarse += abs(step) * weights.y;
    }
    return beyond;
}

/**
 * Returns one sample of a row: a sample of the cell at `uv` and, near its edges, of up to three
 * more.
 */
vec4 sluiceSumDemandCells(SluiceDemandUdim u, vec2 uv, inout bool resident)
{
    vec2 cell = u.base ? SLUICE_SPLAT(vec2, 0.0) : floor(uv);
    uint home = u.index;
    if (u.base) {
        uv /= sluiceDemandSize(u.grid);
    } else if (any(notEqual(cell, u.cell))) {
        home = sluiceDemandCell(u.grid, cell);
        if (!sluiceIsDemandCellOpen(home, resident)) {
            home = u.index;
            cell = u.cell;
        }
    }
    vec2 at = clamp(uv - cell, 0.0, 1.0);
    vec2 side = SLUICE_SELECT(SLUICE_SPLAT(vec2, 1.0), SLUICE_SPLAT(vec2, -1.0), lessThan(at, SLUICE_SPLAT(vec2, 0.5)));
    SluicePagedTaps taps = sluiceDemandLevels(home, u.lod);
    SluiceDemandBeyond beyond = sluiceFindDemandNeighbors(u, home, cell, at, side, taps, resident);
    vec2 reach = max(beyond.fine, beyond.coarse);
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    float total = 0.0;
    SLUICE_DONT_UNROLL for (uint corner = 0u; corner < 4u; corner++) {
        bvec2 next = bvec2((corner & 1u) != 0u, (corner & 2u) != 0u);
        uint index = home;
        if ((next.x && reach.x == 0.0) || (next.y && reach.y == 0.0))
            continue;
        if (corner != 0u) {
            index = sluiceDemandCell(u.grid, cell + SLUICE_SELECT(SLUICE_SPLAT(vec2, 0.0), side, next));
            if (!sluiceIsDemandCellOpen(index, resident))
                continue;
            taps = sluiceDemandLevels(index, u.lod);
        }
        SluiceDemandState s = sluiceOpenDemandCell(index);
        if (taps.fine == sluiceDemandLastLevel(s.shape)) /* the last level has no page */
            sluiceMarkDemandPage(s.tailPage);
        SLUICE_DONT_UNROLL for (uint turn = 0u; turn < 2u; turn++) {
            vec2 weights = turn == 0u ? beyond.fine : beyond.coarse;
            weights = SLUICE_SELECT(1.0 - weights, weights, next);
            float weight = (turn == 0u ? 1.0 - taps.fraction : taps.fraction) * weights.x * weights.y;
            if (!(weight > 0.0))
                continue;
            sum += weight * sluiceDemandTexels(s, turn == 0u ? taps.fine : taps.coarse,
                                               SLUICE_SELECT(at, 0.5 - 0.5 * side, next));
            total += weight;
        }
        resident = resident && s.resident;
    }
    return sum / total;
}

/** Returns both LOD biases. */
float sluiceDemandUdimBias(uint index)
{
    return SLUICE_DEMAND_TEXTURE(index).lodBias + sluiceLoaderLodBias();
}

/** Returns the LOD of a texture that covers `extent` cells, LOD bias included. */
float sluiceDemandUdimLod(uint index, vec2 extent, vec2 dx, vec2 dy, float maxAnisotropy)
{
    vec2 size = sluiceDemandSize(index) / extent;
    return sluiceDemandComputeLod(dx * size, dy * size, maxAnisotropy) + sluiceDemandUdimBias(index);
}

float sluiceDemandAnisotropy(uint index)
{
    return clamp(SLUICE_DEMAND_TEXTURE(index).maxAnisotropy, 1.0, SLUICE_DEMAND_MAX_ANISOTROPY);
}

/**
 * Chooses the base texture or the cell at `uv`. False if there is neither: `color` is the sample.
 */
bool sluiceChooseDemandCell(inout SluiceDemandUdim u, vec2 uv, vec2 dx, vec2 dy, inout bool resident,
                            out vec4 color)
{
    vec2 extent = sluiceDemandSize(u.grid);
    uint base = SLUICE_DEMAND_TEXTURE(u.grid).tailPage;
    u.cell = floor(uv);
    u.index = sluiceDemandCell(u.grid, u.cell);
    u.base = false;
    color = sluiceDemandBaseColor(u.grid);
    if (any(lessThan(uv, SLUICE_SPLAT(vec2, 0.0))) || any(greaterThanEqual(uv, extent)))
        return false;
    bool based = base != 0u;
    if (based)
        based = sluiceIsDemandCellOpen(base, resident);
    if (!resident) /* the base may be sharp enough */
        return false;
    if (based) {
        float lod = sluiceDemandUdimLod(base, extent, dx, dy, sluiceDemandAnisotropy(base));
        u.base = u.index == SLUICE_DEMAND_NO_TEXTURE || !(lod < 0.0);
    }
    bool closed = !u.base && u.index != SLUICE_DEMAND_NO_TEXTURE;
    if (closed)
        closed = !sluiceIsDemandCellOpen(u.index, resident);
    if (closed) {
        color = sluiceDemandBaseColor(u.index);
        u.base = based && SLUICE_DEMAND_PREVIEW &&
                 SLUICE_DEMAND_TEXTURE(u.index).state == SLUICE_DEMAND_TEXTURE_UNKNOWN;
        if (!u.base)
            return false;
    }
    u.index = u.base ? base : u.index;
    return u.index != SLUICE_DEMAND_NO_TEXTURE;
}

/** Samples a UDIM grid with derivatives of `uv` per pixel, in units of one cell. */
vec4 sluiceDemandUdimGrad(uint index, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    SluiceDemandUdim u;
    vec4 color;
    resident = true;
    u.grid = index;
    uv = sluiceIsFinite(uv) ? uv : SLUICE_SPLAT(vec2, 0.0);
    if (SLUICE_DEMAND_TEXTURE(index).state != SLUICE_DEMAND_TEXTURE_GRID)
        return sluiceDemandBaseColor(index); /* removed */
    if (!sluiceChooseDemandCell(u, uv, dx, dy, resident, color))
        return resident || SLUICE_DEMAND_PREVIEW ? color : SLUICE_SPLAT(vec4, 0.0);
    vec2 extent = u.base ? sluiceDemandSize(index) : SLUICE_SPLAT(vec2, 1.0), size = sluiceDemandSize(u.index);
    float n = sluiceDemandAnisotropy(u.index);
    float lod = sluiceDemandUdimLod(u.index, extent, dx, dy, n);
    float last = float(sluiceDemandLastLevel(SLUICE_DEMAND_TEXTURE(u.index).shape));
    float scale = exp2(sluiceDemandUdimBias(u.index));
    bool beyond = !(lod < last);
    u.lod = lod - log2(max(size.x, size.y));
    SluicePagedTaps taps = sluicePlaceTaps(size / extent, uint(last) + 1u, dx * scale, dy * scale,
                                           beyond ? last : max(lod, 0.0), beyond ? 1.0 : n);
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    float step = 1.0 / float(taps.count);
    SLUICE_DONT_UNROLL for (uint i = 0u; i < taps.count; i++)
        sum += sluiceSumDemandCells(u, uv + taps.axis * ((float(i) + 0.5) * step - 0.5), resident);
    return resident || SLUICE_DEMAND_PREVIEW ? sum * step : SLUICE_SPLAT(vec4, 0.0);
}

#endif
