/*
 * Samples textures that are loaded on demand. Returns a color, and whether all its texels were
 * resident. One invocation requests all missing pages, which become resident for a later launch.
 * Never reads a texel that is not resident. C interface: sluice/demand.h.
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
 * Grids: texture floor(uv) of the grid is sampled at uv - floor(uv), clamped to its edge for any
 * address mode. Derivatives of uv are in units of one texture.
 *
 * Macros to define before this file, in addition to the macros of demand_pages.glsl:
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
 *
 * Textures with a bicubic filter (SLUICE_DEMAND_FILTER_CUBIC, _SMART_CUBIC of sluice/demand.h) require
 *
 *     #define SLUICE_DEMAND_CUBIC true                         // or a constant_id constant
 *
 * Default: false. They are then sampled with a linear filter, and shaders have no code for others.
 */
#ifndef SLUICE_DEMAND_GLSL
#define SLUICE_DEMAND_GLSL

#ifndef SLUICE_DEMAND_CUBIC
#define SLUICE_DEMAND_CUBIC false
#endif

#include "demand_filters.glsl"
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

/** Sums all bilinear samples of one sample without bicubic filter and derivatives. */
vec4 sluiceSumDemand(inout SluiceDemandState s, SluicePagedTaps taps, vec2 uv)
{
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    float step = 1.0 / float(taps.count);
    SLUICE_DONT_UNROLL for (uint turn = 0u; turn < 2u; turn++) {
        float share = turn == 0u ? 1.0 - taps.fraction : taps.fraction;
        if (!(share > 0.0))
            continue;
        uint level = turn == 0u ? taps.fine : taps.coarse;
        for (uint i = 0u; i < taps.count; i++) {
            vec2 at = uv + taps.axis * ((float(i) + 0.5) * step - 0.5);
            sum += share * sluiceDemandTexels(s, level, at);
        }
    }
    return sum * step;
}

/** Returns coordinates that sluicePlaceInTile takes: inside the texture if it repeats. */
vec2 sluiceDemandPlaceable(uint shape, vec2 uv)
{
    uvec2 modes = sluiceDemandModes(shape);
    return uv - vec2(modes.x == SLUICE_ADDRESS_MODE_REPEAT ? floor(uv.x) : 0.0,
                     modes.y == SLUICE_ADDRESS_MODE_REPEAT ? floor(uv.y) : 0.0);
}

/** Returns the page of a sample of a level with tiles. */
uint sluiceDemandPageAt(SluiceDemandState s, uint level, vec2 tile)
{
    int shift = sluiceDemandTileShift(s.shape).x;
    uint columns = (max(s.size.x >> level, 1u) + (1u << uint(shift)) - 1u) >> uint(shift);
    return SLUICE_DEMAND_LEVEL_WORD(s.levels + level) + uint(tile.y) * columns + uint(tile.x);
}

/**
 * Takes a sample of one or two levels if all its texels lie in one resident tile of each. False for
 * all other samples: sluiceSumDemand takes those.
 *
 * Most samples end here. Both levels are looked up before either is sampled, because loads take long.
 */
bool sluiceSampleQuickDemand(SluiceDemandState s, SluicePagedTaps taps, vec2 uv, out vec4 color)
{
    color = SLUICE_SPLAT(vec4, 0.0);
    uint fine = taps.fraction < 1.0 ? taps.fine : taps.coarse;
    uint coarse = taps.fraction > 0.0 ? taps.coarse : taps.fine;
    if (coarse >= sluiceDemandRegularCount(s.shape) || (s.shape & SLUICE_DEMAND_NEAREST) != 0u)
        return false;
    vec2 share = sluiceTileShare(sluiceDemandTileShift(s.shape));
    uv = sluiceDemandPlaceable(s.shape, uv);
    SluicePagePlace a = sluicePlaceInTile(uv, vec2(max(s.size >> fine, SLUICE_SPLAT(uvec2, 1u))), share);
    SluicePagePlace b = sluicePlaceInTile(uv, vec2(max(s.size >> coarse, SLUICE_SPLAT(uvec2, 1u))), share);
    if (!(a.inside && b.inside))
        return false;
    uint at, fineWord, coarseWord;
    bool hasFine = sluiceFindDemandPage(sluiceDemandPageAt(s, fine, a.tile), at, fineWord);
    bool hasCoarse = sluiceFindDemandPage(sluiceDemandPageAt(s, coarse, b.tile), at, coarseWord);
    if (!(hasFine && hasCoarse && max(fineWord, coarseWord) < SLUICE_DEMAND_PAGE_REFUSED))
        return false;
    fineWord &= SLUICE_DEMAND_PLACE_MASK;
    coarseWord &= SLUICE_DEMAND_PLACE_MASK;
    vec3 fineAt = vec3(a.local, float(fineWord & 0xFFFFu));
    vec3 coarseAt = vec3(b.local, float(coarseWord & 0xFFFFu));
    vec4 other = SLUICE_SPLAT(vec4, 0.0);
    SLUICE_WITH_PAGE(fineWord, color = SLUICE_ARRAY_SAMPLE(SLUICE_DEMAND_PAGE_TEXTURE(chunk),
                                                           SLUICE_DEMAND_PAGE_SAMPLER(chunk), fineAt))
    if (fine == coarse)
        return true;
    SLUICE_WITH_PAGE(coarseWord, other = SLUICE_ARRAY_SAMPLE(SLUICE_DEMAND_PAGE_TEXTURE(chunk),
                                                             SLUICE_DEMAND_PAGE_SAMPLER(chunk), coarseAt))
    color = (1.0 - taps.fraction) * color;
    color += taps.fraction * other;
    return true;
}

/** Sums all samples of one sample in any filter: color and derivatives. */
mat3x4 sluiceSumKernels(inout SluiceDemandState s, SluicePagedTaps taps, vec2 uv,
                        SluiceDemandKernel kernel, float lod)
{
    mat3x4 sum = SLUICE_SPLAT(mat3x4, 0.0);
    float step = 1.0 / float(taps.count);
    SLUICE_DONT_UNROLL for (uint i = 0u; i < 2u * taps.count; i++) {
        bool coarse = i >= taps.count;
        float share = coarse ? taps.fraction : 1.0 - taps.fraction;
        if (!(share > 0.0))
            continue;
        vec2 at = uv + taps.axis * ((float(coarse ? i - taps.count : i) + 0.5) * step - 0.5);
        sum += share * step * sluiceFilterDemand(s, coarse ? taps.coarse : taps.fine, at, kernel,
                                                 sluiceDemandShare(kernel, lod));
    }
    return sum;
}

/** Finds the texture of a grid at `uv`. False: no texture. */
bool sluiceFindInGrid(inout uint index, inout vec2 uv)
{
    uvec2 size = uvec2(SLUICE_DEMAND_TEXTURE(index).width, SLUICE_DEMAND_TEXTURE(index).height);
    vec2 cell = floor(uv);
    if (any(lessThan(cell, SLUICE_SPLAT(vec2, 0.0))) || any(greaterThanEqual(cell, vec2(size))))
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
    uv = sluiceIsFinite(uv) ? uv : SLUICE_SPLAT(vec2, 0.0);
    if (grid) {
        bool found = sluiceFindInGrid(index, uv);
        if (found)
            state = SLUICE_DEMAND_TEXTURE(index).state;
    }
    color = SLUICE_SPLAT(vec4, 0.0);
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

/** Returns the LOD bias of all textures, while memory is short. */
float sluiceLoaderLodBias()
{
    return uintBitsToFloat(SLUICE_DEMAND_LEVEL_WORD(SLUICE_DEMAND_PARAMETER_LOD_BIAS));
}

/**
 * Samples at `lod`, bias included: color and derivatives. `dx` and `dy` include all LOD bias. A row
 * has up to `maxTaps` samples. `kernel` matters if `any` is true; else the color is linear or
 * nearest, and the derivatives are 0.
 */
mat3x4 sluiceSampleDemand(inout SluiceDemandState s, vec2 uv, vec2 dx, vec2 dy, float lod,
                          float maxTaps, bool any, SluiceDemandKernel kernel)
{
    uint last = sluiceDemandLastLevel(s.shape);
    uvec2 modes = sluiceDemandModes(s.shape);
    bool beyond = !(lod < float(last)); /* NaN */
    if (beyond && modes.x != SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER &&
        modes.y != SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER) {
        sluiceMarkDemandPage(s.tailPage);
        return mat3x4(sluiceDemandBaseColor(s.index), SLUICE_SPLAT(vec4, 0.0), SLUICE_SPLAT(vec4, 0.0));
    }
    lod = beyond ? float(last) : max(lod, 0.0);
    SluicePagedTaps taps =
        sluicePlaceTaps(vec2(s.size), last + 1u, dx, dy, lod, beyond ? 1.0 : maxTaps);
    if ((s.shape & SLUICE_DEMAND_NEAREST_LEVEL) != 0u) {
        taps.fine = uint(max(ceil(lod - 0.5), 0.0));
        taps.fraction = 0.0;
    }
    vec4 color;
    bool done = false;
    if (taps.count == 1u && !any)
        done = sluiceSampleQuickDemand(s, taps, uv, color);
    if (done)
        return mat3x4(color, SLUICE_SPLAT(vec4, 0.0), SLUICE_SPLAT(vec4, 0.0));
    if (taps.fine == last) /* the last level has no page */
        sluiceMarkDemandPage(s.tailPage);
    if (taps.count > 1u || any) /* steps of a row are small beside some coordinates */
        uv = vec2(sluiceNearCoordinate(uv.x, modes.x), sluiceNearCoordinate(uv.y, modes.y));
    mat3x4 sum = SLUICE_SPLAT(mat3x4, 0.0);
    if (any)
        sum = sluiceSumKernels(s, taps, uv, kernel, lod);
    else
        sum[0] = sluiceSumDemand(s, taps, uv);
    return s.resident || SLUICE_DEMAND_PREVIEW ? sum : SLUICE_SPLAT(mat3x4, 0.0);
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

/* Filters of sluiceDemandSample within a level. */
#define SLUICE_DEMAND_AS_TEXTURE 0u /* filter of the texture's sampler */
#define SLUICE_DEMAND_AS_SMART 1u   /* SLUICE_DEMAND_FILTER_SMART_CUBIC for any sampler */
#define SLUICE_DEMAND_AS_SLOPES 2u  /* filter of the texture's sampler, with derivatives */

/**
 * Samples in any way, at `lod`, or at the LOD of the derivatives: color, and derivatives by u and v.
 * `way` must be a constant.
 */
mat3x4 sluiceDemandSample(uint index, vec2 uv, vec2 dx, vec2 dy, bool atLod, float lod, uint way,
                          out bool resident)
{
    SluiceDemandState s;
    mat3x4 sum = SLUICE_SPLAT(mat3x4, 0.0);
    if (sluiceOpenDemand(index, uv, s, sum[0])) {
        vec2 size = vec2(s.size);
        float n = 1.0, loader = sluiceLoaderLodBias();
        if (!atLod) {
            n = clamp(SLUICE_DEMAND_TEXTURE(s.index).maxAnisotropy, 1.0, SLUICE_DEMAND_MAX_ANISOTROPY);
            lod = sluiceDemandComputeLod(dx * size, dy * size, n);
        }
        float bias = SLUICE_DEMAND_TEXTURE(s.index).lodBias, scale = exp2(bias + loader);
        SluiceDemandKernel kernel = sluiceDemandKernel(s.shape, way == SLUICE_DEMAND_AS_SLOPES, lod + bias);
        if (way == SLUICE_DEMAND_AS_SMART) {
            kernel.spline = kernel.smart = true;
            s.shape &= ~SLUICE_DEMAND_NEAREST;
        }
        sum = sluiceSampleDemand(s, uv, dx * scale, dy * scale, lod + (bias + loader), n,
                                 SLUICE_DEMAND_CUBIC || way != SLUICE_DEMAND_AS_TEXTURE, kernel);
    }
    resident = s.resident;
    return sum;
}

/** Samples with derivatives of `uv` per pixel, like textureGrad: trilinear or anisotropic. */
vec4 sluiceDemandGrad(uint index, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    return sluiceDemandSample(index, uv, dx, dy, false, 0.0, SLUICE_DEMAND_AS_TEXTURE, resident)[0];
}

/** Samples at `lod` plus both LOD biases, like textureLod: without anisotropy. */
vec4 sluiceDemandLod(uint index, vec2 uv, float lod, out bool resident)
{
    return sluiceDemandSample(index, uv, SLUICE_SPLAT(vec2, 0.0), SLUICE_SPLAT(vec2, 0.0), true, lod, SLUICE_DEMAND_AS_TEXTURE,
                              resident)[0];
}

/**
 * Samples like sluiceDemandGrad, with SLUICE_DEMAND_FILTER_SMART_CUBIC whatever filter the texture
 * has: bicubic where the texture is magnified to twice its size or more, trilinear or anisotropic
 * where it is not magnified, and a blend between. Does not need SLUICE_DEMAND_CUBIC.
 */
vec4 sluiceDemandCubic(uint index, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    return sluiceDemandSample(index, uv, dx, dy, false, 0.0, SLUICE_DEMAND_AS_SMART, resident)[0];
}

/**
 * Samples like sluiceDemandGrad, and returns the derivatives of the color by u and by v, for example of a
 * height for bump mapping. Does not need SLUICE_DEMAND_CUBIC.
 *
 * `du` and `dv` are per unit of uv: the change across the whole texture. They are exact derivatives of
 * the color at an unchanged LOD. So with a linear filter they are constant between texels and jump
 * at their centers; with a bicubic filter they are continuous. They are 0 for NEAREST, and where the
 * color is 0 because it is not resident.
 */
vec4 sluiceDemandDerivatives(uint index, vec2 uv, vec2 dx, vec2 dy, out vec4 du, out vec4 dv,
                             out bool resident)
{
    mat3x4 sum = sluiceDemandSample(index, uv, dx, dy, false, 0.0, SLUICE_DEMAND_AS_SLOPES, resident);
    du = sum[1];
    dv = sum[2];
    return sum[0];
}

#endif
