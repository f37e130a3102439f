/*
 * Samples textures that are loaded on demand. Returns a color, and whether everything that it is
 * made of was resident. Missing pages are requested, all of them in one invocation, and become
 * resident for a later launch. Never touches a texel that is not resident. C interface:
 * sluice/demand.h.
 *
 *     bool resident;
 *     vec4 color = sluiceDemandGrad(index, uv, dx, dy, resident);
 *     if (!resident) // keep the ray, and trace it again in the next launch
 *
 * `index`, of a texture or a grid, is the low 32 bits of a SluiceDemandTextureId. It may differ
 * between invocations. The functions are long, and compiled where they are called: call one
 * function, in one place. All functions may be called in any stage and any control flow, because
 * they take no derivatives. Address modes, filters, anisotropy and LOD bias are the texture's.
 * While memory is short, the loader's LOD bias is added. Special cases:
 *
 *     texture not opened yet                (0, 0, 0, 0), not resident; requests that it be opened
 *     texture that cannot be opened         its failureColor, resident
 *     LOD at or beyond the last level       color of the last level and its border; no page is read
 *     derivatives that are infinite or NaN  color of the last level and its border
 *     LOD that is NaN                       color of the last level and its border
 *     uv not finite, or beyond 1e33         as at (0, 0)
 *     tile that will never be resident      the next coarser level, resident
 *
 * Grids: texture floor(uv) of the grid is sampled at uv - floor(uv), clamped to its edge whatever
 * its address modes are. Derivatives are those of uv, in units of one texture.
 *
 * Macros to define before you include it, in addition to those of demand_pages.glsl:
 *
 *     #define SLUICE_DEMAND_TEXTURE(i) textures.entries[i]     // SluiceDemandTexture, read
 *     #define SLUICE_DEMAND_PAGE_TEXTURE(i) pages[nonuniformEXT(i)] // sampler2DArray: sluiceGetDemandPages
 *
 * SLUICE_DEMAND_PAGE_TEXTURE defaults to SLUICE_PAGE_TEXTURE. A shader that also samples streamed
 * textures must define both: a new page image is in the two arrays at different times.
 *
 * Define SLUICE_PAGE_LOOP if arrays cannot be indexed like that (buffers.glsl). With
 *
 *     #define SLUICE_DEMAND_PREVIEW true                       // or a constant_id constant
 *
 * missing levels are replaced by the finest coarser level that is resident, or by the color of the
 * last level. Samples still return not resident, and request what they miss. Requires
 * GL_EXT_control_flow_attributes, an extension of the compiler only.
 */
#ifndef SLUICE_DEMAND_GLSL
#define SLUICE_DEMAND_GLSL

#include "demand_texels.glsl"
#include "lod.glsl"

#define SLUICE_DEMAND_MAX_ANISOTROPY 64.0

/* LOD that is coarser than any level, but finite. */
#define SLUICE_DEMAND_NO_LOD 256.0

/** Returns an equivalent coordinate near the texture, by subtracting whole periods. */
float sluiceNearCoordinate(float coordinate, uint addressMode)
{
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT || addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT)
        return coordinate - 2.0 * floor(coordinate * 0.5);
    return coordinate;
}

/**
 * Returns the weights of a cubic B-spline for texels -1 and 0. `t` runs from texel 0 to texel 1.
 */
vec2 sluiceSplineWeights(float t)
{
    float back = 1.0 - t;
    return vec2(back * back * back, 3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0;
}

/**
 * Returns one half of an axis of a bicubic sample as a linear sample: coordinate x, weight y.
 * `second` selects the half.
 */
vec2 sluiceSplineHalf(float coordinate, float n, bool second)
{
    float at = clamp(coordinate, -1.0e9, 1.0e9) * n - 0.5; /* beyond, nothing changes */
    float low = floor(at), t = at - low;
    vec2 w = second ? sluiceSplineWeights(1.0 - t).yx : sluiceSplineWeights(t);
    float sum = w.x + w.y;
    return vec2((low + (second ? 1.5 : -0.5) + w.y / sum) / n, sum);
}

/**
 * Returns the coordinate of part 0 to 3 of a bicubic sample of level 0, a bilinear sample.
 * Multiplies `weight` by its weight.
 */
vec2 sluiceCubicPart(SluiceDemandState s, vec2 uv, uint part, inout float weight)
{
    vec2 x = sluiceSplineHalf(uv.x, float(s.size.x), (part & 1u) != 0u);
    vec2 y = sluiceSplineHalf(uv.y, float(s.size.y), (part & 2u) != 0u);
    weight *= x.y * y.y;
    return vec2(x.x, y.x);
}

/** Sums all bilinear samples of one sample. Only samples of level 0 are bicubic. */
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

/** Finds the texture of a grid at `uv`. False if there is none. */
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

/** Returns whether the texture is open and has pages. If false, `color` is the sample. */
bool sluiceOpenDemand(uint index, inout vec2 uv, out SluiceDemandState s, out vec4 color)
{
    s.resident = true;
    uint state = SLUICE_DEMAND_TEXTURE(index).state;
    bool grid = state == SLUICE_DEMAND_TEXTURE_GRID;
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

/**
 * Samples at `lod`, bias included. `dx` and `dy` include all LOD bias. A row has up to `maxTaps`
 * samples.
 */
vec4 sluiceSampleDemand(inout SluiceDemandState s, vec2 uv, vec2 dx, vec2 dy, float lod,
                        float maxTaps, bool cubic)
{
    uint last = sluiceDemandLastLevel(s.shape);
    uvec2 modes = sluiceDemandModes(s.shape);
    bool beyond = !(lod < float(last)); /* NaN */
    if (beyond && modes.x != SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER &&
        modes.y != SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER) {
        sluiceMarkDemandPage(s.tailPage);
        return sluiceDemandBaseColor(s.index);
    }
    lod = beyond ? float(last) : max(lod, 0.0);
    SluicePagedTaps taps =
        sluicePlaceTaps(vec2(s.size), last + 1u, dx, dy, lod, beyond ? 1.0 : maxTaps);
    if ((s.shape & SLUICE_DEMAND_NEAREST_LEVEL) != 0u) {
        taps.fine = uint(max(ceil(lod - 0.5), 0.0));
        taps.fraction = 0.0;
    }
    if (taps.fine == last) /* it has no page */
        sluiceMarkDemandPage(s.tailPage);
    if (taps.count > 1u || cubic) /* steps of a row are small beside some coordinates */
        uv = vec2(sluiceNearCoordinate(uv.x, modes.x), sluiceNearCoordinate(uv.y, modes.y));
    if (cubic)
        s.shape &= ~SLUICE_DEMAND_NEAREST;
    vec4 color = sluiceSumDemand(s, taps, uv, cubic);
    return s.resident || SLUICE_DEMAND_PREVIEW ? color : vec4(0.0);
}

/**
 * Returns the LOD without bias. Derivatives are in texels of level 0.
 *
 * It is log2 of the longer of two lengths: the short axis of the ellipse that the derivatives span,
 * and the longer derivative divided by `maxAnisotropy`. Exact to 1e-4 if the sum of the derivatives
 * is a normal number. SLUICE_DEMAND_NO_LOD if they are infinite or NaN.
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

/** Samples in any way: at `lod`, or at the LOD of the derivatives. */
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

/** Samples with derivatives of `uv` per pixel, like textureGrad: trilinear or anisotropic. */
vec4 sluiceDemandGrad(uint index, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    return sluiceDemandSample(index, uv, dx, dy, false, 0.0, false, resident);
}

/**
 * Samples like sluiceDemandGrad, with a bicubic B-spline where the texture is magnified. The spline
 * is smooth and does not interpolate the texels. It blends gradually into the trilinear filter,
 * which applies from level 1 on. The texture's filter within a level is ignored.
 */
vec4 sluiceDemandCubic(uint index, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    return sluiceDemandSample(index, uv, dx, dy, false, 0.0, true, resident);
}

/** Samples at `lod` plus both LOD biases, like textureLod: without anisotropy. */
vec4 sluiceDemandLod(uint index, vec2 uv, float lod, out bool resident)
{
    return sluiceDemandSample(index, uv, vec2(0.0), vec2(0.0), true, lod, false, resident);
}

#endif
