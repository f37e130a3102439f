/*
 * Samples a streamed texture where it is resident: at the wanted level, or at the finest level that
 * the MinMip map shows around the sample. Never touches a texel that is not resident.
 *
 * The sampler must have no LOD bias, minLod 0, maxLod VK_LOD_CLAMP_NONE, and the address modes of
 * SluiceVulkanTexture.
 *
 * Every function takes the texture as its first argument: a sampler2D; or a number, if SLUICE_TEXTURE
 * is defined. Then the texture is SLUICE_TEXTURE(number), and the number need not be uniform:
 *
 *     #define SLUICE_TEXTURE(i) textures[nonuniformEXT(i)]
 *     #define SLUICE_TEXTURE(i) nonuniformEXT(sampler2D(images[nonuniformEXT(i)], samplers[0]))
 *
 * The outer nonuniformEXT() is required: without it compilers do not mark the sampler2D as
 * non-uniform. bindings.glsl defines SLUICE_TEXTURE for the array of textures of a streamer.
 *
 * In paged mode the sampler sees only the packed levels; paged.glsl samples the others. In other
 * modes a sample that needs no clamping uses the texture like one that is not streamed, so the
 * settled picture equals that of a fully resident texture.
 *
 * Textures with a bicubic filter (SluiceVulkanTextureCreateInfo.filter) require
 *
 *     #define SLUICE_CUBIC true   // or a constant_id constant
 *
 * in all shaders that sample them or write their feedback. Default: false. They are then sampled with
 * a linear filter, and shaders have no code for others.
 * Bicubic samples have computed levels, like those of paged mode, and rows of samples for anisotropy.
 */
#ifndef SLUICE_SAMPLE_GLSL
#define SLUICE_SAMPLE_GLSL

#include "buffers.glsl"
#include "cubic.glsl"
#include "footprint.glsl"
#include "lod.glsl"
#include "page_filter.glsl"
#include "quick.glsl"
#ifdef SLUICE_PAGED
#include "paged.glsl"
#endif

/*
 * Define SLUICE_MIN_LOD if the device feature shaderResourceMinLod is enabled. Samples are then
 * clamped by textureGradClampARB, and isotropic samples keep their own derivatives. Without it,
 * clamped samples get wider derivatives. Both show the same level: devices that clamp also scale
 * the row of an anisotropic footprint.
 */
#if defined(SLUICE_MIN_LOD) && !defined(SLUICE_HLSL)
#extension GL_ARB_sparse_texture_clamp : require
#endif

/* Color where not even the packed levels are resident. Define it before to change it. */
#ifndef SLUICE_FALLBACK_COLOR
#define SLUICE_FALLBACK_COLOR vec4(0.5, 0.5, 0.5, 1.0)
#endif

/* LOD bias of implicit samples that every device supports (maxSamplerLodBias). Samplers clamp more. */
#define SLUICE_MAX_IMPLICIT_LOD_BIAS 2.0

/*
 * Some devices read levels coarser than Vulkan's formula for long anisotropic footprints
 * (docs/drivers.md), so residency is checked there, too. Define it as false, or as a constant_id
 * constant, to skip that check on devices that do not.
 */
#ifndef SLUICE_ANISOTROPY_OVERREACHES
#define SLUICE_ANISOTROPY_OVERREACHES true
#endif

/*
 * Longest derivatives, in texels. Products of the squares of longer ones exceed the range of float,
 * and samplers may then choose any level. They count as infinite.
 */
#define SLUICE_MAX_TEXELS 1.0e9

/* LOD below which a footprint is treated as a point. */
#define SLUICE_LOD_POINT -16.0

/** Resolved sample: what may be sampled. */
struct SluiceSampling {
    vec2 uv;            /* input uv; 0 if not finite */
    vec2 dx, dy;        /* for textureGrad: with LOD bias, coarsened if necessary */
    float lod;          /* approximately what the sampler will choose */
    uint wantedLevel;   /* the finest level touched if all were resident */
    uint level;         /* the finest level that may be touched; SLUICE_MIP_UNTOUCHED: none */
    uint missing;       /* levels by which it is too coarse, rounded up */
    float minLod;       /* for textureGradClampARB, with SLUICE_MIN_LOD; else 0 */
    bool plain;         /* texture() touches only resident texels, and may be used */
};

/* In both halves: coarser than any level, but something. */
#define SLUICE_SHOWN_UNKNOWN 0xFEFFFEFFu

/** Returns the larger of two words, half by half. */
uint sluiceMaxHalves(uint a, uint b)
{
    return max(a & 0xFFFFu, b & 0xFFFFu) | (max(a >> 16u, b >> 16u) << 16u);
}

/**
 * Reads the words of the MinMip buffer under a footprint of samples of `finestLevel` and coarser.
 * Returns the largest low half (levels of the regions) and the largest high half (levels of the
 * regions and around them).
 */
uint sluiceMaxMinMip(uint first, SluiceGrid grid, SluiceFootprint footprint, uint finestLevel)
{
    uvec2 step = uvec2(
        sluiceRangeStep(footprint.first.x, footprint.last.x, grid.last.x, finestLevel),
        sluiceRangeStep(footprint.first.y, footprint.last.y, grid.last.y, finestLevel));
    uvec2 at = footprint.first;
    uint words = 0u;
    for (;;) {
        words = sluiceMaxHalves(
            words, SLUICE_MIN_MIP_WORD(first + at.y * (grid.last.x + 1u) + at.x));
        if (at.x != footprint.last.x) {
            at.x = sluiceNextRegion(at.x, footprint.last.x, grid.last.x, step.x);
            continue;
        }
        if (at.y == footprint.last.y)
            break;
        at = uvec2(footprint.first.x,
                   sluiceNextRegion(at.y, footprint.last.y, grid.last.y, step.y));
    }
    /* skipped tiles are unknown: only packed levels are certain */
    return max(step.x, step.y) > 1u << finestLevel ? sluiceMaxHalves(words, SLUICE_SHOWN_UNKNOWN) : words;
}

/**
 * Widens derivatives to a footprint that is nowhere narrower than `width` texels.
 *
 * The longer derivative is kept, so an anisotropic footprint keeps its length. The other one
 * becomes orthogonal to it: two nearly parallel derivatives form a narrow footprint, however long
 * they are.
 */
void sluiceWiden(inout vec2 dx, inout vec2 dy, vec2 size, float width)
{
    vec2 tx = dx * size;
    vec2 ty = dy * size;
    vec2 major = dot(tx, tx) >= dot(ty, ty) ? tx : ty;
    float majorLength = length(major);
    /* 0, denormal or NaN: it has no direction */
    vec2 direction = majorLength > 1.0e-15 ? major / majorLength : vec2(1.0, 0.0);
    dx = direction * (majorLength >= width ? majorLength : width) / size;
    dy = vec2(-direction.y, direction.x) * width / size;
}

/**
 * Returns whether levels coarser than `coarsest` are resident as well, up to `lod`, the LOD without
 * anisotropy. Some samplers read them. They reach further to the sides, over other tiles.
 */
bool sluiceReachIsThere(uint first, SluiceGrid grid, vec2 uv, vec2 halfBox, uint coarsest, float lod)
{
    uint widest = sluiceCoarsestLevel(lod, sluiceMipCount(grid));
    if (widest <= coarsest)
        return true;
    SluiceFootprint at = sluiceComputeFootprint(grid, uv, halfBox, widest);
    uint shown = sluiceMaxMinMip(first, grid, at, coarsest + 1u) & 0xFFFFu;
    return sluiceShownLevel(shown) <= coarsest + 1u;
}

/**
 * Returns the LOD without anisotropy if samplers may come near it; else a LOD too fine to count.
 */
float sluiceOverreachedLod(uint shape, vec2 dx, vec2 dy, float lodBias, float maxAnisotropy)
{
    bool overreaches =
        SLUICE_ANISOTROPY_OVERREACHES && maxAnisotropy > 1.0 && !SLUICE_HAS_PAGES(shape);
    return overreaches ? sluiceComputeLod(dx, dy, lodBias, 1.0) : -SLUICE_LOD_LIMIT;
}

/** Returns whether the sampler is passed the finest level that it may use. */
bool sluiceSamplerClamps(uint shape)
{
#ifdef SLUICE_MIN_LOD
    return !SLUICE_HAS_PAGES(shape);
#else
    return false;
#endif
}

/**
 * Returns the words (sluiceMaxMinMip) for a sample of `lod`, of levels `finest` to `coarsest`.
 *
 * At the rim of the sample's box only coarser levels are read. Only those must be resident there;
 * the rim does not make the sample coarser.
 */
uint sluiceReadBox(uint first, SluiceGrid grid, vec2 uv, vec2 halfBox, float lod, float margin,
                   uint finest, uint coarsest)
{
    for (;;) {
        uint words =
            sluiceMaxMinMip(first, grid, sluiceComputeFootprint(grid, uv, halfBox, coarsest), finest);
        if (sluiceLodLimit(words & 0xFFFFu, margin) <= lod ||
            sluiceShownLevel(words & 0xFFFFu) > finest + 1u || coarsest <= finest)
            return words;
        coarsest = finest;
    }
}

/**
 * Returns the coarsest level of a sample that is clamped to `lod`, and enlarges `halfBox` if
 * necessary.
 */
uint sluiceClampedBox(uint shape, float lod, float margin, float coarsestLod, float maxAnisotropy,
                      uint count, inout vec2 halfBox)
{
    if (maxAnisotropy > 1.0)
        halfBox = max(halfBox, SLUICE_SPLAT(vec2, exp2(lod - margin)));
    else if (sluiceSamplerClamps(shape))
        return sluiceCoarsestLevel(max(lod, coarsestLod), count); /* exactly */
    return sluiceCoarsestLevel(lod + margin, count); /* coarser by as much as finer */
}

/**
 * Returns the LOD of a sample that, clamped to what its box shows, would touch still coarser
 * levels.
 *
 * `words` are those of its box for samples up to `coarsest`. The result is the LOD that they show,
 * if it requires no larger box; else the LOD of the regions around, if the box reaches no further;
 * else that of packed levels.
 */
float sluiceLodAround(uint tableIndex, SluiceGrid grid, uint words, uint coarsest, float margin,
                      float coarsestLod, float maxAnisotropy, vec2 halfBox)
{
    uint count = sluiceMipCount(grid);
    float packed = float(SLUICE_TEXTURE_ENTRY(tableIndex).regularMipCount) + margin;
    float lod = min(sluiceLodLimit(words & 0xFFFFu, margin), packed);
    vec2 grown = halfBox;
    if (sluiceClampedBox(grid.shape, lod, margin, coarsestLod, maxAnisotropy, count, grown) <=
            coarsest &&
        all(equal(grown, halfBox)))
        return lod;
    lod = min(sluiceLodLimit(words >> 16u, margin), packed);
    uint level =
        sluiceClampedBox(grid.shape, lod, margin, coarsestLod, maxAnisotropy, count, grown);
    bool uneven = (grid.shape & SLUICE_SHAPE_UNEVEN) != 0u;
    vec2 more = grown - halfBox + SLUICE_WIDE_APRON(grid, uneven ? SLUICE_APRON_UNEVEN : SLUICE_APRON) *
                                      exp2(float(level));
    return all(lessThan(more, sluiceRegionSize(grid))) ? lod : packed;
}

/**
 * Returns true if texture() certainly touches only resident texels. `dx` and `dy` are the
 * derivatives of `uv` per pixel. If false, call sluiceResolveSampling for the exact answer.
 */
bool sluiceIsSurelyThere(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                         float maxAnisotropy)
{
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    dx *= size;
    dy *= size;
    float x2 = dot(dx, dx), y2 = dot(dy, dy), sum = x2 + y2;
    float scale2 = sluiceBiasScale2(lodBias);
    float finest2 = max(x2, y2); /* 4 to the power of the LOD, at most */
    if (maxAnisotropy > 1.0) {
        float n = sluiceClampAnisotropy(maxAnisotropy);
        float area = dx.x * dy.y - dx.y * dy.x;
        finest2 = max(area * area / sum, finest2 / (n * n));
        if (!(finest2 > exp2(2.0 * SLUICE_LOD_POINT)))
            return false;
    }
    if (!(sum * scale2 < SLUICE_MAX_TEXELS * SLUICE_MAX_TEXELS && abs(lodBias) <= SLUICE_QUICK_BIAS &&
          sluiceIsFinite(uv)))
        return false;
    if (SLUICE_TEXTURE_ENTRY(tableIndex).wholeShown == 0u)
        return true;
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uvec2 region = sluiceQuickRegion(grid, uv);
    uint around = SLUICE_MIN_MIP_WORD(SLUICE_TEXTURE_ENTRY(tableIndex).minMipOffset +
                                      region.y * (grid.last.x + 1u) + region.x) >> 16u;
    float limit = (float(around) - float(SLUICE_SHOWN_MARGIN)) / float(SLUICE_SHOWN_STEPS) +
                  sluiceLodMargin(maxAnisotropy) - lodBias;
    if (sum * scale2 < SLUICE_TEXTURE_ENTRY(tableIndex).quickReach2)
        return around == 0u || finest2 >= exp2(2.0 * limit);
    return around < SLUICE_SHOWN_NOTHING &&
           finest2 * exp2(2.0 * lodBias) >= SLUICE_TEXTURE_ENTRY(tableIndex).quickPacked2;
}

/**
 * Determines what a sample may touch. `dx` and `dy` are the derivatives of `uv` per pixel.
 *
 * Use it where sluiceSampleGrad cannot be called: then call sluiceTextureGrad, or sluiceSamplePaged in
 * paged mode. If s.level is SLUICE_MIP_UNTOUCHED, do not sample.
 */
SluiceSampling sluiceResolveSampling(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                                     float maxAnisotropy)
{
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uint first = SLUICE_TEXTURE_ENTRY(tableIndex).minMipOffset;
    uint count = sluiceMipCount(grid);
    float margin = sluiceLodMargin(maxAnisotropy);
    SluiceSampling s;
    float biasScale = exp2(sluiceClampLodBias(lodBias));
    vec2 largest = SLUICE_SPLAT(vec2, SLUICE_MAX_TEXELS) / (grid.size * max(biasScale, 1.0));
    bool finite = sluiceIsFinite(uv) && all(lessThanEqual(abs(dx), largest)) &&
                  all(lessThanEqual(abs(dy), largest));
    s.uv = sluiceIsFinite(uv) ? uv : SLUICE_SPLAT(vec2, 0.0);
    vec2 lods = finite
                    ? sluiceComputeLods(dx * grid.size, dy * grid.size, lodBias, maxAnisotropy)
                    : SLUICE_SPLAT(vec2, SLUICE_LOD_LIMIT);
    s.lod = lods.x;
    s.minLod = 0.0;
    s.wantedLevel = sluiceFinestLevel(s.lod, margin, count);
    s.level = s.wantedLevel;
    s.missing = 0u;
    s.plain = false;
    s.dx = finite ? dx * biasScale : SLUICE_SPLAT(vec2, 0.0);
    s.dy = finite ? dy * biasScale : SLUICE_SPLAT(vec2, 0.0);
    dx *= grid.size;
    dy *= grid.size;
    /* An anisotropic footprint of length 0 has no ratio: some samplers divide by it. */
    bool isPoint = !(s.lod > SLUICE_LOD_POINT) && maxAnisotropy > 1.0;
    bool widened = !finite;

    vec2 halfBox = finite ? sluiceHalfBox(dx, dy, lodBias, maxAnisotropy) : SLUICE_SPLAT(vec2, 0.0);
    float reach = finite ? sluiceOverreachedLod(grid.shape, dx, dy, lodBias, maxAnisotropy)
                         : -SLUICE_LOD_LIMIT;
    uint coarsest = sluiceCoarsestLevel(lods.y, count);
    uint shown = sluiceReadBox(first, grid, s.uv, halfBox, s.lod, margin, s.level, coarsest) & 0xFFFFu;
    bool round = sluiceLodLimit(shown, margin) <= s.lod &&
                 !sluiceReachIsThere(first, grid, s.uv, halfBox, coarsest, reach);
    if (round) { /* such a footprint has but one level */
        halfBox = max(halfBox, SLUICE_SPLAT(vec2, 0.5 * exp2(s.lod)));
        shown = sluiceReadBox(first, grid, s.uv, halfBox, s.lod, margin, s.level, coarsest) & 0xFFFFu;
    }
    if (shown >= SLUICE_SHOWN_NOTHING) {
        s.level = s.missing = SLUICE_MIP_UNTOUCHED;
        return s;
    }
    if (sluiceLodLimit(shown, margin) > s.lod) {
        s.lod = min(sluiceLodLimit(shown, margin),
                    max(float(SLUICE_TEXTURE_ENTRY(tableIndex).regularMipCount) + margin, s.lod));
        coarsest =
            sluiceClampedBox(grid.shape, s.lod, margin, lods.y, maxAnisotropy, count, halfBox);
        uint words = sluiceReadBox(first, grid, s.uv, halfBox, s.lod, margin,
                                   sluiceFinestLevel(s.lod, margin, count), coarsest);
        if (sluiceLodLimit(words & 0xFFFFu, margin) > s.lod) {
            s.lod = sluiceLodAround(tableIndex, grid, words, coarsest, margin, lods.y, maxAnisotropy,
                                    halfBox);
            round = round || reach > -SLUICE_LOD_LIMIT;
        } else {
            round = round || !sluiceReachIsThere(first, grid, s.uv, halfBox, coarsest, reach);
        }
        s.level = sluiceFinestLevel(s.lod, margin, count);
        s.missing = max(uint(ceil(max(s.lod - margin, 0.0))) - s.wantedLevel, 1u);
        s.minLod = sluiceSamplerClamps(grid.shape) ? min(s.lod, float(count - 1u)) : 0.0;
        widened = widened || maxAnisotropy > 1.0 || !sluiceSamplerClamps(grid.shape);
    }
    s.plain = finite && !isPoint && !round && s.missing == 0u;
    if (!finite)
        s.lod = min(s.lod, float(s.level) + margin);
    float width = exp2(widened || round ? max(s.lod, SLUICE_LOD_POINT) : SLUICE_LOD_POINT);
    if (round) {
        s.dx = vec2(width, 0.0) / grid.size;
        s.dy = vec2(0.0, width) / grid.size;
    } else if (widened || isPoint) {
        sluiceWiden(s.dx, s.dy, grid.size, width);
    }
    return s;
}

/**
 * Returns by how many levels a sample is too coarse. SLUICE_MIP_UNTOUCHED if nothing is resident.
 */
uint sluiceMissingLevels(SluiceSampling s)
{
    return s.missing;
}

/** Determines what a sample may touch, the short way if possible. */
SluiceSampling sluiceFindSampling(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                                  float maxAnisotropy)
{
    if (!sluiceIsSurelyThere(tableIndex, uv, dx, dy, lodBias, maxAnisotropy))
        return sluiceResolveSampling(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    float scale = exp2(sluiceClampLodBias(lodBias));
    float lod = sluiceComputeLod(dx * size, dy * size, lodBias, maxAnisotropy);
    SluiceSampling s;
    s.uv = uv;
    s.dx = dx * scale;
    s.dy = dy * scale;
    s.lod = lod;
    s.wantedLevel = s.level = s.missing = 0u;
    s.minLod = 0.0;
    s.plain = false;
    return s;
}

bool sluiceHasSpline(uint tableIndex)
{
    return (SLUICE_TEXTURE_ENTRY(tableIndex).shape & SLUICE_SHAPE_SPLINE) != 0u;
}

/**
 * Returns how much of a sample that shows s.lod is bicubic. The other arguments are those of the
 * sample.
 */
float sluiceSplineShare(uint tableIndex, SluiceSampling s, vec2 dx, vec2 dy, float lodBias,
                        float maxAnisotropy)
{
    uint shape = SLUICE_TEXTURE_ENTRY(tableIndex).shape;
    if (!SLUICE_CUBIC || (shape & SLUICE_SHAPE_SPLINE) == 0u)
        return 0.0;
    if ((shape & SLUICE_SHAPE_SMART) == 0u)
        return 1.0;
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    return sluiceCubicShare(max(s.lod, 0.0) - sluiceComputeLod(dx * size, dy * size, lodBias, maxAnisotropy));
}

#ifdef SLUICE_FRAGMENT_SHADER

/** Returns true if the whole texture may be shown, and texture() handles any derivatives. */
bool sluiceIsWhole(uint tableIndex, float lodBias, float maxAnisotropy)
{
    return !SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape) && !(maxAnisotropy > 1.0) &&
           abs(lodBias) <= SLUICE_MAX_IMPLICIT_LOD_BIAS &&
           SLUICE_TEXTURE_ENTRY(tableIndex).wholeShown == 0u;
}

/** Returns true in all four pixels of a quad if `value` is true in any of them. */
bool sluiceAnyInQuad(bool value)
{
    float any = value ? 1.0 : 0.0;
    any += abs(dFdxFine(any));
    any += abs(dFdyFine(any));
    return any > 0.0;
}

/** Returns true in all four pixels of a quad if `number` differs among them. Numbers up to 2^24. */
bool sluiceDiffersInQuad(uint number)
{
    return sluiceAnyInQuad(abs(dFdxFine(float(number))) + abs(dFdyFine(float(number))) > 0.0);
}

#endif

#define SLUICE_FORM_GRAD(tex, uv, dx, dy) \
    SLUICE_TEXTURE_GRAD(SLUICE_FORM_TEXTURE(tex), SLUICE_FORM_SAMPLER(tex), uv, dx, dy)
#define SLUICE_FORM_GRAD_CLAMP(tex, uv, dx, dy, minLod) \
    SLUICE_TEXTURE_GRAD_CLAMP(SLUICE_FORM_TEXTURE(tex), SLUICE_FORM_SAMPLER(tex), uv, dx, dy, minLod)
#define SLUICE_FORM_LOD(tex, uv, lod) \
    SLUICE_TEXTURE_LOD(SLUICE_FORM_TEXTURE(tex), SLUICE_FORM_SAMPLER(tex), uv, lod)
#define SLUICE_FORM_BIAS(tex, uv, bias) \
    SLUICE_TEXTURE_BIAS(SLUICE_FORM_TEXTURE(tex), SLUICE_FORM_SAMPLER(tex), uv, bias)
#define SLUICE_FORM_FETCH(tex, texel, level) SLUICE_TEXTURE_FETCH(SLUICE_FORM_TEXTURE(tex), texel, level)

/* The functions that take a texture, in both forms. */
#define SLUICE_FORM(tex) SLUICE_SAMPLER_2D(tex)
#define SLUICE_FORM_PASS(tex) SLUICE_PASS_SAMPLER(tex)
#define SLUICE_FORM_TEXTURE(tex) tex
#define SLUICE_FORM_SAMPLER(tex) SLUICE_SAMPLER_OF(tex)
#include "sample_textures.glsl"
#ifdef SLUICE_TEXTURE
#define SLUICE_FORM(tex) uint tex
#define SLUICE_FORM_PASS(tex) tex
#define SLUICE_FORM_TEXTURE(tex) SLUICE_TEXTURE(tex)
#define SLUICE_FORM_SAMPLER(tex) SLUICE_TEXTURE_SAMPLER(tex)
#define SLUICE_FORM_IS_NUMBER
#include "sample_textures.glsl"
#endif

#endif
