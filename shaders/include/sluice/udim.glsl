/*
 * Samples UDIM sets of streamed textures: finds the cells of a sample and their weights. The
 * application has the tableIndex of each cell, and samples each by the functions of sample.glsl or
 * sample_array.glsl. Cells may be textures, or layers of an array. For demand loading see
 * demand_grids.glsl.
 *
 *     vec4 sum = vec4(0.0);
 *     float total = 0.0;
 *     for (uint i = 0u; i < SLUICE_UDIM_PARTS; i++) {
 *         SluiceUdimPart part = sluiceFindUdimPart(grid, size, uv, dx, dy, lodBias, maxAnisotropy, i);
 *         if (part.weight > 0.0 && ...the cell part.cell has a texture...) {
 *             sum += part.weight * ...a sample of the cell at part.uv, with dx and dy...
 *             total += part.weight;
 *             ...feedback of the cell at part.uv, with dx and dy...
 *         }
 *     }
 *
 * The color is sum / total; if total is 0, there is no texture. Add the textures with
 * VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, and sample them so.
 *
 * A sample within half a texel of an edge, at its LOD, blends with the next cell. The next cell has
 * half of the weight at the edge, so colors on both sides meet. The last level, of one texel, blends
 * everywhere. With one level this is the filter of one large image. Between two levels the weights
 * of both are averaged.
 */
#ifndef SLUICE_UDIM_GLSL
#define SLUICE_UDIM_GLSL

#include "lod.glsl"

/* Most cells of a sample. The first is the cell at uv. */
#define SLUICE_UDIM_PARTS 4u

/** Cell that a sample reads. */
struct SluiceUdimPart {
    uint cell;    /* column + columns * row */
    vec2 uv;      /* in the cell, 0 to 1 */
    float weight; /* 0: the sample does not read it */
};

/** Returns the weights of the next cells in x and y at a level. `edge` is the distance in uv. */
vec2 sluiceUdimBeyond(vec2 size, vec2 edge, float level)
{
    return max(0.5 - edge * vec2(max(uvec2(size) >> uint(level), SLUICE_SPLAT(uvec2, 1u))), 0.0);
}

/**
 * Returns part 0 to SLUICE_UDIM_PARTS - 1 of a sample.
 *
 * `grid` is the number of columns and rows. `size` is that of level 0 of the cell at `uv`. `uv` is in
 * units of one cell, `dx` and `dy` are its derivatives per pixel. Outside the grid all weights are 0.
 */
SluiceUdimPart sluiceFindUdimPart(uvec2 grid, vec2 size, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                                  float maxAnisotropy, uint part)
{
    if (!sluiceIsFinite(uv))
        uv = SLUICE_SPLAT(vec2, 0.0);
    vec2 home = floor(uv), at = clamp(uv - home, 0.0, 1.0);
    vec2 side = vec2(at.x < 0.5 ? -1.0 : 1.0, at.y < 0.5 ? -1.0 : 1.0);
    float lod = sluiceComputeLod(dx * size, dy * size, lodBias, maxAnisotropy);
    lod = clamp(lod, 0.0, floor(log2(max(size.x, size.y)) + 0.001));
    vec2 edge = min(at, 1.0 - at);
    vec2 beyond = mix(sluiceUdimBeyond(size, edge, floor(lod)),
                      sluiceUdimBeyond(size, edge, floor(lod) + 1.0), fract(lod));
    bvec2 next = bvec2((part & 1u) != 0u, (part & 2u) != 0u);
    vec2 cell = home + vec2(next.x ? side.x : 0.0, next.y ? side.y : 0.0);
    vec2 weights = vec2(next.x ? beyond.x : 1.0 - beyond.x, next.y ? beyond.y : 1.0 - beyond.y);
    vec2 opposite = 0.5 - 0.5 * side;
    bool inside = all(greaterThanEqual(vec4(home, cell), SLUICE_SPLAT(vec4, 0.0))) &&
                  all(lessThan(vec4(home, cell), vec4(grid, grid)));
    SluiceUdimPart p;
    p.cell = inside ? uint(cell.x) + grid.x * uint(cell.y) : 0u;
    p.uv = vec2(next.x ? opposite.x : at.x, next.y ? opposite.y : at.y);
    p.weight = inside ? weights.x * weights.y : 0.0;
    return p;
}

#endif
