/*
 * Samples cube maps that are loaded on demand, filtered across the edges of their faces.
 *
 * A cube map is a grid of textures, one per face, in the order +X, -X, +Y, -Y, +Z, -Z
 * (sluiceAddDemandGrid, SluiceDemandImage.arrayLayer). Several cubes are a grid of all their faces.
 *
 *     bool resident;
 *     vec4 color = sluiceDemandCubeGrad(index, cube, direction, dx, dy, resident);
 *
 *     beyond an edge                        texels of the face there. Its textures are opened and its
 *                                           pages requested like those of the face that is hit
 *     where three faces meet                the fourth texel is the mean of the other three
 *     a texel that will never be resident   all four are taken from the next coarser level
 *     face that cannot be opened            its failureColor, resident
 *     empty cell                            the grid's missingColor, resident
 *     direction that is 0, infinite or NaN  the last level of face 0 of the cube
 *     texture that is no grid               its base color, resident
 *
 * Faces must be square and equal in size; otherwise edges are visible. Anisotropy, LOD bias and filters
 * come from the face that is hit. Bicubic filters are linear here; NEAREST does not cross edges. Indices
 * beyond the last cube select the last cube.
 *
 * Include it after the definitions of demand.glsl, which it includes.
 */
#ifndef SLUICE_DEMAND_CUBES_GLSL
#define SLUICE_DEMAND_CUBES_GLSL

#include "cube_faces.glsl"
#include "demand_grids.glsl"

/** Cube of a grid. */
struct SluiceDemandCube {
    uint grid, first; /* first: word of face 0 */
    bool resident;
};

/** Returns the texture of a face, or SLUICE_DEMAND_NO_TEXTURE. */
uint sluiceDemandCubeFace(SluiceDemandCube c, uint face)
{
    return SLUICE_DEMAND_LEVEL_WORD(c.first + face);
}

/**
 * Fetches a texel of a level of `size` texels; beyond an edge, from the face there. `home` is the
 * texture of `face`. If the other face is not open, returns the texel at the edge.
 */
vec4 sluiceFetchDemandCube(inout SluiceDemandCube c, uint home, uint face, uint level, ivec2 texel,
                           int size, bool ask, out uint worst)
{
    ivec2 inside = clamp(texel, SLUICE_SPLAT(ivec2, 0), SLUICE_SPLAT(ivec2, size - 1));
    uint index = home;
    worst = 0u;
    if (any(notEqual(texel, inside))) {
        vec2 uv = sluiceFoldOverEdge(face, (vec2(texel) + 0.5) / float(size));
        uint other = sluiceDemandCubeFace(c, face);
        if (sluiceIsDemandCellOpen(other, c.resident)) {
            index = other;
            level = min(level, sluiceDemandLastLevel(SLUICE_DEMAND_TEXTURE(index).shape));
            ivec2 extent = max(ivec2(sluiceDemandSize(index)) >> int(level), SLUICE_SPLAT(ivec2, 1));
            inside = clamp(ivec2(uv * vec2(extent)), SLUICE_SPLAT(ivec2, 0), extent - 1);
        } else if (c.resident) {
            return sluiceDemandBaseColor(other == SLUICE_DEMAND_NO_TEXTURE ? c.grid : other);
        }
    }
    SluiceDemandState s = sluiceOpenDemandCell(index);
    bool last = level == sluiceDemandLastLevel(s.shape);
    if (last) /* the last level has no page */
        sluiceMarkDemandPage(s.tailPage);
    SluicePageAxis x, y;
    x.low = x.high = inside.x;
    y.low = y.high = inside.y;
    x.weight = y.weight = 0.0;
    return sluiceGatherDemand(s, sluiceReadDemandLevel(s, level), last, x, y, ask, worst);
}

/** Returns a bilinear sample of a level, like sluiceDemandBilinear. `s` is of the texture of `face`. */
vec4 sluiceDemandCubeBilinear(inout SluiceDemandCube c, inout SluiceDemandState s, uint face,
                              uint level, vec2 uv, bool ask, out uint worst)
{
    int size = max(int(s.size.x) >> int(level), 1);
    vec2 at = floor(uv * float(size) * SLUICE_FILTER_STEPS - (0.5 * SLUICE_FILTER_STEPS - 0.5)) /
              SLUICE_FILTER_STEPS;
    ivec2 low = ivec2(floor(at));
    if ((s.shape & SLUICE_DEMAND_NEAREST) != 0u || (min(low.x, low.y) >= 0 && max(low.x, low.y) < size - 1))
        return sluiceDemandBilinear(s, level, uv, ask, worst);
    vec2 weight = at - floor(at);
    vec4 sum = SLUICE_SPLAT(vec4, 0.0), known = SLUICE_SPLAT(vec4, 0.0);
    float corner = 0.0;
    worst = 0u;
    SLUICE_DONT_UNROLL for (int i = 0; i < 4; i++) {
        ivec2 side = ivec2(i & 1, i >> 1), texel = low + side;
        vec2 shares = mix(1.0 - weight, weight, vec2(side));
        float share = shares.x * shares.y;
        bvec2 outside = notEqual(texel, clamp(texel, SLUICE_SPLAT(ivec2, 0), SLUICE_SPLAT(ivec2, size - 1)));
        if (all(outside))
            corner = share;
        if (all(outside) || !(share > 0.0)) /* texels of weight 0 may be infinite */
            continue;
        uint found;
        vec4 color = sluiceFetchDemandCube(c, s.index, face, level, texel, size, ask, found);
        worst = max(worst, found);
        sum += share * color;
        known += color;
    }
    return corner > 0.0 ? sum + corner * known / 3.0 : sum;
}

/** Returns a bilinear sample of `level`, or of a coarser level, like sluiceDemandTexels. */
vec4 sluiceDemandCubeTexels(inout SluiceDemandCube c, inout SluiceDemandState s, uint face, uint level,
                            vec2 uv)
{
    uint regular = sluiceDemandRegularCount(s.shape);
    bool ask = true;
    for (;;) {
        uint worst;
        vec4 color = sluiceDemandCubeBilinear(c, s, face, level, uv, ask || level >= regular, worst);
        if (worst < SLUICE_DEMAND_PAGE_REFUSED)
            return color;
        if (worst == SLUICE_PAGE_NONE) {
            c.resident = false;
            if (!SLUICE_DEMAND_PREVIEW)
                return SLUICE_SPLAT(vec4, 0.0);
            ask = false;
        }
        level = level < regular ? level + 1u : sluiceDemandLastLevel(s.shape);
    }
}

/** Returns one sample of a row. Beyond an edge it is on the face there. */
vec4 sluiceSumDemandCube(inout SluiceDemandCube c, uint face, vec2 uv, SluicePagedTaps taps)
{
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    if (any(notEqual(uv, clamp(uv, 0.0, 1.0)))) {
        vec3 zero = SLUICE_SPLAT(vec3, 0.0);
        SluiceCubePoint at = sluiceFindCubePoint(sluiceCubeDirection(face, uv), zero, zero);
        face = at.face;
        uv = at.uv;
    }
    uint index = sluiceDemandCubeFace(c, face);
    if (!sluiceIsDemandCellOpen(index, c.resident))
        return c.resident ? sluiceDemandBaseColor(index == SLUICE_DEMAND_NO_TEXTURE ? c.grid : index) : sum;
    SluiceDemandState s = sluiceOpenDemandCell(index);
    uint last = sluiceDemandLastLevel(s.shape);
    SLUICE_DONT_UNROLL for (uint i = 0u; i < 2u; i++) {
        float share = i > 0u ? taps.fraction : 1.0 - taps.fraction;
        if (!(share > 0.0))
            continue;
        uint level = min(i > 0u ? taps.coarse : taps.fine, last);
        if (level == last) /* the last level has no page */
            sluiceMarkDemandPage(s.tailPage);
        sum += share * sluiceDemandCubeTexels(c, s, face, level, uv);
    }
    return sum;
}

/**
 * Samples cube number `cube` of a grid with derivatives of `direction` per pixel. The direction need not
 * have length 1.
 */
vec4 sluiceDemandCubeGrad(uint index, uint cube, vec3 direction, vec3 dx, vec3 dy, out bool resident)
{
    SluiceDemandCube c;
    resident = true;
    uint count = SLUICE_DEMAND_TEXTURE(index).width * SLUICE_DEMAND_TEXTURE(index).height / 6u;
    if (SLUICE_DEMAND_TEXTURE(index).state != SLUICE_DEMAND_TEXTURE_GRID || count == 0u)
        return sluiceDemandBaseColor(index);
    c.grid = index;
    c.first = SLUICE_DEMAND_TEXTURE(index).levels + 6u * min(cube, count - 1u);
    c.resident = true;
    SluiceCubePoint p = sluiceFindCubePoint(direction, dx, dy);
    uint home = sluiceDemandCubeFace(c, p.face);
    if (!sluiceIsDemandCellOpen(home, resident))
        return !resident ? SLUICE_SPLAT(vec4, 0.0)
                         : sluiceDemandBaseColor(home == SLUICE_DEMAND_NO_TEXTURE ? index : home);
    vec2 size = sluiceDemandSize(home);
    uint shape = SLUICE_DEMAND_TEXTURE(home).shape, last = sluiceDemandLastLevel(shape);
    float n = sluiceDemandAnisotropy(home), bias = sluiceDemandUdimBias(home);
    float lod = sluiceDemandComputeLod(p.dx * size, p.dy * size, n) + bias;
    bool beyond = !(p.finite && lod < float(last)); /* NaN */
    lod = beyond ? float(last) : max(lod, 0.0);
    SluicePagedTaps taps = sluicePlaceTaps(size, last + 1u, p.dx * exp2(bias), p.dy * exp2(bias), lod,
                                           beyond ? 1.0 : n);
    if ((shape & SLUICE_DEMAND_NEAREST_LEVEL) != 0u) {
        taps.fine = uint(max(ceil(lod - 0.5), 0.0));
        taps.fraction = 0.0;
    }
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    float step = 1.0 / float(taps.count);
    SLUICE_DONT_UNROLL for (uint i = 0u; i < taps.count; i++)
        sum += sluiceSumDemandCube(c, p.face, p.uv + taps.axis * ((float(i) + 0.5) * step - 0.5), taps);
    resident = c.resident;
    return resident || SLUICE_DEMAND_PREVIEW ? sum * step : SLUICE_SPLAT(vec4, 0.0);
}

#endif
