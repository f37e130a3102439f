/*
 * Records the level that a sample wants, resident or not.
 *
 * Select few pixels first (stochastic.glsl). Take derivatives before that branch, or inside it if
 * whole quads take the branch. sluiceWriteQuadFeedback then shares the work among the pixels of a
 * quad:
 *
 *     vec2 dx = dFdx(uv), dy = dFdy(uv);
 *     if (sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, seed, 1.0 / 16.0))
 *         sluiceWriteQuadFeedback(tableIndex, uv, dx, dy, 0.0, 8.0, uvec2(gl_FragCoord.xy), seed);
 *
 * For a texture set, write once, with the primary's index. In compute and ray tracing shaders pass
 * your own derivatives, for instance of ray cones.
 *
 * Optional definitions before this file, in addition to the definitions of buffers.glsl:
 *
 *     #define SLUICE_FEEDBACK_ENCODING SLUICE_FEEDBACK_MASKS  // as the streamer's; default: LEVELS
 *     #define SLUICE_FEEDBACK_TURN_WORD(i) turns.words[i]     // uint, read; default: all take part
 *
 * SLUICE_FEEDBACK_TURN_WORD skips textures that are not resolved in this frame, at the cost of one
 * load. See SluiceVulkanStreamerCreateInfo.feedbackInTurns.
 */
#ifndef SLUICE_FEEDBACK_GLSL
#define SLUICE_FEEDBACK_GLSL

#include "buffers.glsl"
#include "footprint.glsl"
#include "lod.glsl"
#include "shared/feedback.h"

#ifndef SLUICE_FEEDBACK_ENCODING
#define SLUICE_FEEDBACK_ENCODING SLUICE_FEEDBACK_LEVELS
#endif

/** Reads the feedback of region `at`. */
uint sluiceReadFeedback(uint at)
{
#if SLUICE_FEEDBACK_ENCODING == SLUICE_FEEDBACK_MASKS
    return SLUICE_FEEDBACK_WORD(at >> 1u) >> ((at & 1u) * 16u);
#else
    return SLUICE_FEEDBACK_WORD(at);
#endif
}

/**
 * Marks region `at`, unless `known`, the value read there, includes the mark: loads are cheaper
 * than atomics.
 */
void sluiceMarkUnlessKnown(uint at, uint level, uint known)
{
#if SLUICE_FEEDBACK_ENCODING == SLUICE_FEEDBACK_MASKS
    uint bit = 1u << min(level, SLUICE_FEEDBACK_MASK_LEVELS - 1u);
    if ((known & (bit | (bit - 1u))) == 0u)
        SLUICE_ATOMIC_OR(SLUICE_FEEDBACK_WORD(at >> 1u), bit << ((at & 1u) * 16u));
#else
    if (level < known)
        SLUICE_ATOMIC_MIN(SLUICE_FEEDBACK_WORD(at), level);
#endif
}

/** Marks a region. `at` is its index in the feedback buffer. */
void sluiceMarkRegionAt(uint at, uint level)
{
    sluiceMarkUnlessKnown(at, level, sluiceReadFeedback(at));
}

void sluiceMarkRegion(SluiceTextureEntry entry, uint x, uint y, uint level)
{
    sluiceMarkRegionAt(entry.feedbackOffset + y * entry.regionCountX + x, level);
}

/** Returns whether feedback of this texture is read back in this frame. */
bool sluiceTakesPart(uint tableIndex)
{
#ifdef SLUICE_FEEDBACK_TURN_WORD
    return (SLUICE_FEEDBACK_TURN_WORD(tableIndex >> 5u) >> (tableIndex & 31u) & 1u) != 0u;
#else
    return true;
#endif
}

/**
 * Marks every tile of `level` and coarser levels that a footprint covers. The map begins at
 * `first`.
 */
void sluiceMarkFootprint(uint first, SluiceGrid grid, SluiceFootprint footprint, uint level)
{
    uvec2 step = uvec2(
        sluiceRangeStep(footprint.first.x, footprint.last.x, grid.last.x, level),
        sluiceRangeStep(footprint.first.y, footprint.last.y, grid.last.y, level));
    uvec2 at = footprint.first;
    for (;;) {
        sluiceMarkRegionAt(first + at.y * (grid.last.x + 1u) + at.x, level);
        if (at.x != footprint.last.x) {
            at.x = sluiceNextRegion(at.x, footprint.last.x, grid.last.x, step.x);
            continue;
        }
        if (at.y == footprint.last.y)
            return;
        at = uvec2(footprint.first.x,
                   sluiceNextRegion(at.y, footprint.last.y, grid.last.y, step.y));
    }
}

/**
 * Returns the region of a texel coordinate, at most one image size outside. For textures of
 * SLUICE_SHAPE_QUICK.
 */
uvec2 sluiceCornerRegion(SluiceGrid grid, vec2 texel)
{
    if ((grid.shape & SLUICE_SHAPE_REPEATS) == 0u)
        texel = clamp(texel, SLUICE_SPLAT(vec2, 0.0), grid.size - 0.5);
    return uvec2(ivec2(floor(texel)) >> ivec2(sluiceRegionShift(grid))) & grid.last;
}

/** Marks the corners of a box of texels. For textures of SLUICE_SHAPE_QUICK. */
void sluiceMarkCorners(uint first, SluiceGrid grid, vec2 low, vec2 high, uint level)
{
    uvec2 from = sluiceCornerRegion(grid, low), to = sluiceCornerRegion(grid, high);
    uint upper = first + from.y * (grid.last.x + 1u);
    sluiceMarkRegionAt(upper + from.x, level);
    if (all(equal(from, to)))
        return;
    /* loads first, because they take long */
    uint lower = first + to.y * (grid.last.x + 1u);
    uint right = sluiceReadFeedback(upper + to.x), below = sluiceReadFeedback(lower + from.x),
         across = sluiceReadFeedback(lower + to.x);
    if (to.x != from.x)
        sluiceMarkUnlessKnown(upper + to.x, level, right);
    if (to.y != from.y)
        sluiceMarkUnlessKnown(lower + from.x, level, below);
    if (to.x != from.x && to.y != from.y)
        sluiceMarkUnlessKnown(lower + to.x, level, across);
}

/** Returns how far the box of a sample reaches, in texels. For textures of SLUICE_SHAPE_QUICK. */
vec2 sluiceBoxReach(SluiceGrid grid, vec2 halfBox, uint coarsest)
{
    float texel = uintBitsToFloat((coarsest + 127u) << 23u); /* 2 to the power of it */
    return halfBox + SLUICE_WIDE_APRON(grid, SLUICE_APRON) * min(vec2(texel), grid.size);
}

/**
 * Returns whether the corners of a box touch every tile of `level` that the box covers. A `halfBox`
 * of 0 is small.
 */
bool sluiceCornersAreAll(SluiceGrid grid, vec2 halfBox, vec2 reach, uint level)
{
    if ((grid.shape & SLUICE_SHAPE_QUICK) == 0u)
        return false;
    return !(halfBox.x > 0.0 || halfBox.y > 0.0) ||
           all(lessThanEqual(2.0 * reach, sluiceRegionSize(grid) * exp2(float(level))));
}

/** Returns the position of a sample in texels; inside the image if the texture repeats. */
vec2 sluiceQuickTexel(SluiceGrid grid, vec2 uv)
{
    return ((grid.shape & SLUICE_SHAPE_REPEATS) != 0u ? uv - floor(uv) : uv) * grid.size;
}

/** Marks all regions that a sample of `level` to `coarsest` touches. */
void sluiceMarkBox(uint first, SluiceGrid grid, vec2 uv, vec2 halfBox, uint level, uint coarsest)
{
    vec2 reach = sluiceBoxReach(grid, halfBox, coarsest);
    if (!sluiceCornersAreAll(grid, halfBox, reach, level)) {
        sluiceMarkFootprint(first, grid, sluiceComputeFootprint(grid, uv, halfBox, coarsest), level);
        return;
    }
    vec2 at = sluiceQuickTexel(grid, uv);
    sluiceMarkCorners(first, grid, at - reach, at + reach, level);
}

/**
 * Marks all regions that a sample with derivatives touches. `dx` and `dy` are in texels.
 *
 * Some devices read levels up to `widest`, the level without anisotropy, which reach further
 * (docs/feedback.md).
 */
void sluiceMarkSample(uint tableIndex, SluiceGrid grid, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                      float maxAnisotropy, uint level, uint coarsest, uint widest)
{
    uint first = SLUICE_TEXTURE_ENTRY(tableIndex).feedbackOffset;
    vec2 halfBox = sluiceHalfBox(dx, dy, lodBias, maxAnisotropy);
    sluiceMarkBox(first, grid, uv, halfBox, level, coarsest);
    if (maxAnisotropy > 1.0 && widest > coarsest)
        sluiceMarkBox(first, grid, uv, halfBox, coarsest + 1u, widest);
}

/** Returns whether sluiceQuickLevels has the levels of a sample. */
bool sluiceAreQuick(SluiceSquares squares, vec2 uv, float lodBias)
{
    return squares.sum < SLUICE_QUICK_SQUARES && abs(lodBias) <= SLUICE_QUICK_BIAS && sluiceIsFinite(uv);
}

/** Returns the finest, coarsest and widest level of a sample. Derivatives are in texels. */
uvec3 sluiceMarkedLevels(SluiceGrid grid, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                         float maxAnisotropy)
{
    SluiceSquares squares = sluiceSquareLods(dx, dy, maxAnisotropy);
    if (sluiceAreQuick(squares, uv, lodBias))
        return sluiceQuickLevels(squares, lodBias, maxAnisotropy, sluiceMipCount(grid));
    return sluiceSafeLevels(uv, dx, dy, lodBias, maxAnisotropy, sluiceMipCount(grid));
}

/**
 * Marks every region that a sample at `uv` touches with the finest level that it may touch there.
 *
 * `dx` and `dy` are the derivatives of `uv` per pixel. Pass LOD bias and anisotropy of the sample
 * (1: none). If `uv` or a derivative is not finite, or the bias is NaN, only the coarsest level is
 * marked. Never writes outside the texture's own map. Helper invocations write nothing.
 */
void sluiceWriteFeedback(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                         float maxAnisotropy)
{
    if (!sluiceTakesPart(tableIndex))
        return;
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    dx *= grid.size;
    dy *= grid.size;
    uvec3 levels = sluiceMarkedLevels(grid, uv, dx, dy, lodBias, maxAnisotropy);
    sluiceMarkSample(tableIndex, grid, uv, dx, dy, lodBias, maxAnisotropy, levels.x, levels.y,
                     levels.z);
}

/** Returns `reach` toward one corner of a box: both signs follow from bits 0 of `pixel` and a seed. */
vec2 sluiceCornerOffset(vec2 reach, uvec2 pixel, uint frameSeed)
{
    uvec2 negative = ~(pixel ^ uvec2(frameSeed, frameSeed >> 1u)) << 31u;
    return uintBitsToFloat(floatBitsToUint(reach) ^ negative);
}

/** Marks the region of a texel coordinate. For textures of SLUICE_SHAPE_QUICK. */
void sluiceMarkTexel(uint first, SluiceGrid grid, vec2 texel, uint level)
{
    uvec2 region = sluiceCornerRegion(grid, texel);
    sluiceMarkRegionAt(first + region.y * (grid.last.x + 1u) + region.x, level);
}

/**
 * Writes feedback like sluiceWriteFeedback, for 2x2 quads whose pixels are selected together
 * (sluiceSelectRandomQuad and similar). Each pixel marks another corner of its footprint, so four
 * pixels cost little more than one.
 *
 * `pixel` selects the corner. The two low bits of `frameSeed` rotate the corners: what only one
 * corner of one pixel reaches is marked in one of four frames that select it. Footprints that are
 * not simple boxes are marked completely. For probabilities near 1 use sluiceWriteFeedback, which
 * marks everything at once.
 */
void sluiceWriteQuadFeedback(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                             float maxAnisotropy, uvec2 pixel, uint frameSeed)
{
    if (!sluiceTakesPart(tableIndex))
        return;
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uint first = SLUICE_TEXTURE_ENTRY(tableIndex).feedbackOffset;
    vec2 tx = dx * grid.size, ty = dy * grid.size;
    SluiceSquares squares = sluiceSquareLods(tx, ty, maxAnisotropy);
    uvec3 levels = sluiceQuickLevels(squares, lodBias, maxAnisotropy, sluiceMipCount(grid));
    vec2 halfBox = sluiceHalfBox(tx, ty, lodBias, maxAnisotropy);
    vec2 reach = sluiceBoxReach(grid, halfBox, levels.y), wide = sluiceBoxReach(grid, halfBox, levels.z);
    bool wider = maxAnisotropy > 1.0 && levels.z > levels.y;
    /* One branch, at the end: the code before it has no other way to go. */
    bool quick = sluiceAreQuick(squares, uv, lodBias) && sluiceCornersAreAll(grid, halfBox, reach, levels.x) &&
                 (!wider || sluiceCornersAreAll(grid, halfBox, wide, levels.y + 1u));
    if (!quick) {
        sluiceWriteFeedback(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
        return;
    }
    vec2 at = sluiceQuickTexel(grid, uv);
    sluiceMarkTexel(first, grid, at + sluiceCornerOffset(reach, pixel, frameSeed), levels.x);
    if (wider)
        sluiceMarkTexel(first, grid, at + sluiceCornerOffset(wide, pixel, frameSeed), levels.y + 1u);
}

/**
 * Writes feedback of textureLod: the level is `lod`, without anisotropy. NaN marks the coarsest
 * level.
 */
void sluiceWriteFeedbackLod(uint tableIndex, vec2 uv, float lod)
{
    if (!sluiceTakesPart(tableIndex))
        return;
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uint count = sluiceMipCount(grid);
    lod = sluiceIsFinite(uv) ? sluiceClampLod(lod) : SLUICE_LOD_LIMIT;
    sluiceMarkBox(SLUICE_TEXTURE_ENTRY(tableIndex).feedbackOffset, grid, uv, SLUICE_SPLAT(vec2, 0.0),
                  sluiceFinestLevel(lod, 0.0, count), sluiceCoarsestLevel(lod, count));
}

#ifdef SLUICE_FEEDBACK_QUERY
/* Largest difference of two evaluations of one LOD: a step of its fraction. */
#define SLUICE_QUERY_MARGIN (1.0 / 256.0)

/**
 * Returns the LOD that the device will use, for sluiceWriteFeedbackQueried; neither clamped nor
 * rounded. Fragment shaders only, in uniform control flow, best before any branch.
 *
 * If the pixels of a quad disagree, the finest of a pixel and its two neighbors counts. The
 * differences also keep compilers from moving the query into a branch, where the neighbors are
 * missing.
 */
float sluiceQueryLod(SLUICE_SAMPLER_2D(tex), vec2 uv)
{
    float lod = SLUICE_QUERY_LOD(tex, SLUICE_SAMPLER_OF(tex), uv);
    float spread = abs(dFdxFine(lod)) + abs(dFdyFine(lod));
    return spread > 0.0 ? lod - spread : lod; /* NaN stays in its pixel and does not spread */
}

/**
 * Writes feedback like sluiceWriteFeedback, with the LOD that the device reports. For comparison.
 * Define SLUICE_FEEDBACK_QUERY to have it.
 *
 * It needs no margin for other LOD formulas, but it needs a texture and derivatives, so every pixel
 * pays for it and not only the selected ones. `lod` is the result of sluiceQueryLod before the
 * selection, with the whole streamed texture and its sampler. In paged mode the computed LOD is
 * used.
 *
 * With anisotropy the finer of reported and computed LOD counts: if the ratio of derivatives
 * exceeds maxAnisotropy, a widely used driver reports a LOD that is coarser than its samples, by
 * half the excess.
 */
void sluiceWriteFeedbackQueried(float lod, uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                                float maxAnisotropy)
{
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape)) {
        sluiceWriteFeedback(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
        return;
    }
#endif
    if (!sluiceTakesPart(tableIndex))
        return;
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uint count = sluiceMipCount(grid);
    dx *= grid.size;
    dy *= grid.size;
    uvec3 levels = sluiceSafeLevels(uv, dx, dy, lodBias, maxAnisotropy, count);
    bool known = lod == lod && sluiceIsFinite(uv);
    lod = known ? sluiceClampLod(lod + sluiceClampLodBias(lodBias)) : SLUICE_LOD_LIMIT;
    uint level = sluiceFinestLevel(lod - SLUICE_QUERY_MARGIN, 0.0, count);
    uint coarsest = sluiceCoarsestLevel(known ? lod + SLUICE_QUERY_MARGIN : lod, count);
    if (known && maxAnisotropy > 1.0)
        level = min(level, levels.x);
    if (known) /* sample.glsl looks as far around as the computed level may reach */
        coarsest = max(coarsest, levels.y);
    sluiceMarkSample(tableIndex, grid, uv, dx, dy, lodBias, maxAnisotropy, level, coarsest, levels.z);
}

/**
 * Queries the LOD and writes feedback. Call in uniform control flow, with `selected` rather than a
 * branch around it.
 */
void sluiceWriteFeedbackQuery(SLUICE_SAMPLER_2D(tex), uint tableIndex, vec2 uv, float lodBias,
                              float maxAnisotropy, bool selected)
{
    float lod = sluiceQueryLod(SLUICE_PASS_SAMPLER(tex), uv);
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    if (selected)
        sluiceWriteFeedbackQueried(lod, tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
}
#endif

#endif
