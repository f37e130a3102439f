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
 *     LOD at or beyond the last level       the colour of the last level, and of the border around it;
 *                                           no page is looked up
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
 * last level: samples still say that they are not resident, and ask for what they miss. Needs
 * GL_EXT_control_flow_attributes, a matter of the compiler alone.
 */
#ifndef SLUICE_DEMAND_GLSL
#define SLUICE_DEMAND_GLSL

#include "demand_texels.glsl"
#include "lod.glsl"

#define SLUICE_DEMAND_MAX_ANISOTROPY 64.0

/* Coarser than any level, but finite. */
#define SLUICE_DEMAND_NO_LOD 256.0

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
    float step = 1.0 / float(taps.count);
    [[dont_unroll]] for (uint pass = 0u; pass < 2u; pass++) {
        float share = pass == 0u ? 1.0 - taps.fraction : taps.fraction;
        if (!(share > 0.0))
            continue;
        uint level = pass == 0u ? taps.fine : taps.coarse;
        uint parts = cubic && level == 0u ? 2u : 0u; /* log2 */
        for (uint i = 0u; i < taps.count << parts; i++) {
            vec2 at = uv + taps.axis * ((float(i >> parts) + 0.5) * step - 0.5);
            float weight = share;
            if (parts != 0u)
                at = sluiceCubicPart(s, at, i & 3u, weight);
            sum += weight * sluiceDemandTexels(s, level, at);
        }
    }
    return sum * step;
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
