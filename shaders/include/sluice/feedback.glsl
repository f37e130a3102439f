/*
 * Writes down which level a sample wants, whether it is resident or not.
 *
 * Select few pixels first (stochastic.glsl), and take the derivatives before that branch:
 *
 *     vec2 dx = dFdx(uv), dy = dFdy(uv);
 *     if (sluiceSelectRandomQuad(uvec2(gl_FragCoord.xy), seed, 1.0 / 16.0))
 *         sluiceWriteFeedback(tableIndex, uv, dx, dy, 0.0, 8.0);
 *
 * A texture set writes once, with the primary's index. In compute and ray tracing shaders the
 * derivatives are whatever the caller knows: of ray cones, for instance.
 *
 * To be defined before this file, besides what buffers.glsl says:
 *
 *     #define SLUICE_FEEDBACK_ENCODING SLUICE_FEEDBACK_MASKS  // as the streamer's; default: LEVELS
 *     #define SLUICE_FEEDBACK_TURN_WORD(i) turns.words[i]     // uint, read; default: all take part
 *
 * The second one leaves out textures that are not resolved in this frame, at the cost of one load:
 * see SluiceVulkanStreamerCreateInfo.feedbackInTurns.
 */
#ifndef SLUICE_FEEDBACK_GLSL
#define SLUICE_FEEDBACK_GLSL

#include "buffers.glsl"
#include "footprint.glsl"
#include "lod.glsl"
#include "quick.glsl"
#include "shared/feedback.h"

#ifndef SLUICE_FEEDBACK_ENCODING
#define SLUICE_FEEDBACK_ENCODING SLUICE_FEEDBACK_LEVELS
#endif

/* Most writes change nothing, and a load is far cheaper than an atomic. */
/** `at` is the number of the region in the feedback buffer. */
void sluiceMarkRegionAt(uint at, uint level)
{
#if SLUICE_FEEDBACK_ENCODING == SLUICE_FEEDBACK_MASKS
    uint shift = (at & 1u) * 16u;
    uint bit = 1u << min(level, SLUICE_FEEDBACK_MASK_LEVELS - 1u);
    uint asFine = bit | (bit - 1u);
    if ((SLUICE_FEEDBACK_WORD(at >> 1u) >> shift & asFine) == 0u)
        atomicOr(SLUICE_FEEDBACK_WORD(at >> 1u), bit << shift);
#else
    if (level < SLUICE_FEEDBACK_WORD(at))
        atomicMin(SLUICE_FEEDBACK_WORD(at), level);
#endif
}

void sluiceMarkRegion(SluiceTextureEntry entry, uint x, uint y, uint level)
{
    sluiceMarkRegionAt(entry.feedbackOffset + y * entry.regionCountX + x, level);
}

/** Whether what is written for this texture in this frame is asked for. */
bool sluiceTakesPart(uint tableIndex)
{
#ifdef SLUICE_FEEDBACK_TURN_WORD
    return (SLUICE_FEEDBACK_TURN_WORD(tableIndex >> 5u) >> (tableIndex & 31u) & 1u) != 0u;
#else
    return true;
#endif
}

void sluiceMarkFootprint(SluiceTextureEntry entry, SluiceFootprint at, uint level)
{
    sluiceMarkRegion(entry, at.x.x, at.y.x, level);
    if (sluiceFootprintIsOneRegion(at))
        return;
    uvec2 steps = sluiceFootprintSteps(at, level);
    for (uint i = 1u; i < steps.x * steps.y; i++) {
        uvec2 region = sluiceFootprintRegion(at, level, uvec2(i % steps.x, i / steps.x));
        sluiceMarkRegion(entry, region.x, region.y, level);
    }
}

/** What a sample touches if its finest and its coarsest level are these. */
void sluiceMarkSample(SluiceTextureEntry entry, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                      float maxAnisotropy, uint level, uint coarsest)
{
    vec2 size = vec2(entry.width, entry.height);
    vec2 halfBox = sluiceHalfBox(dx, dy, lodBias, maxAnisotropy);
    sluiceMarkFootprint(entry, sluiceComputeFootprint(entry, uv, halfBox, coarsest), level);
    if (!(maxAnisotropy > 1.0))
        return;
    /* Some devices read levels up to those without anisotropy, which reach further: docs/feedback.md. */
    uint widest = sluiceCoarsestLevel(sluiceComputeLods(dx * size, dy * size, lodBias, 1.0).y,
                                      entry.mipLevelCount);
    if (widest > coarsest)
        sluiceMarkFootprint(entry, sluiceComputeFootprint(entry, uv, halfBox, widest),
                            coarsest + 1u);
}

/** Marks the region of a sample that surely stays inside it; false if that is not sure. */
bool sluiceMarkOneRegion(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                         float maxAnisotropy)
{
    uint shape = SLUICE_TEXTURE_ENTRY(tableIndex).quickShape;
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    dx *= size;
    dy *= size;
    float x2 = dot(dx, dx), y2 = dot(dy, dy);
    float reach2 = (x2 + y2) * sluiceBiasScale2(lodBias);
    vec2 texel = sluiceQuickTexel(tableIndex, uv, shape);
    uvec2 shift = sluiceQuickShift(shape);
    uvec2 region = sluiceQuickRegion(tableIndex, texel, shape);
    vec2 before = texel - vec2(region << shift);
    vec2 room = min(before, vec2(uvec2(1u) << shift) - before);
    float reach = SLUICE_REACH * sqrt(max(reach2, 1.0));
    if (!(room.x > reach && room.y > reach && abs(lodBias) <= SLUICE_QUICK_BIAS &&
          reach2 < SLUICE_TEXTURE_ENTRY(tableIndex).quickReach2 &&
          (shape & SLUICE_QUICK_ONE_REGION) != 0u))
        return false;
    float lod = maxAnisotropy > 1.0 ? sluiceComputeLod(dx, dy, lodBias, maxAnisotropy)
                                    : 0.5 * log2(max(x2, y2)) + lodBias;
    uint level = sluiceFinestLevel(lod, sluiceLodMargin(maxAnisotropy),
                                   (shape >> SLUICE_QUICK_LAST_LEVEL_SHIFT) + 1u);
    sluiceMarkRegionAt(SLUICE_TEXTURE_ENTRY(tableIndex).feedbackOffset +
                           region.y * (SLUICE_TEXTURE_ENTRY(tableIndex).regionLastX + 1u) + region.x,
                       level);
    return true;
}

/**
 * Marks every region that a sample at `uv` touches with the finest level that it may touch there.
 * `dx` and `dy` are the derivatives of `uv` per pixel; bias and anisotropy as the sample has them
 * (1: none). `uv` and derivatives that are not finite, and a bias that is NaN, mark the coarsest level
 * alone. Never writes outside the texture's own map. Helper invocations write nothing.
 */
void sluiceWriteFeedback(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                         float maxAnisotropy)
{
    if (!sluiceTakesPart(tableIndex))
        return;
    if (sluiceMarkOneRegion(tableIndex, uv, dx, dy, lodBias, maxAnisotropy))
        return;
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    vec2 size = vec2(entry.width, entry.height);
    vec2 lods = sluiceIsFinite(uv) ? sluiceComputeLods(dx * size, dy * size, lodBias, maxAnisotropy)
                                   : vec2(SLUICE_LOD_LIMIT);
    uint level = sluiceFinestLevel(lods.x, sluiceLodMargin(maxAnisotropy), entry.mipLevelCount);
    uint coarsest = sluiceCoarsestLevel(lods.y, entry.mipLevelCount);
    sluiceMarkSample(entry, uv, dx, dy, lodBias, maxAnisotropy, level, coarsest);
}

/** The same for textureLod: the level is given, and there is no anisotropy. NaN is the coarsest. */
void sluiceWriteFeedbackLod(uint tableIndex, vec2 uv, float lod)
{
    if (!sluiceTakesPart(tableIndex))
        return;
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    lod = sluiceIsFinite(uv) ? sluiceClampLod(lod) : SLUICE_LOD_LIMIT;
    SluiceFootprint at = sluiceComputeFootprint(entry, uv, vec2(0.0),
                                                sluiceCoarsestLevel(lod, entry.mipLevelCount));
    sluiceMarkFootprint(entry, at, sluiceFinestLevel(lod, 0.0, entry.mipLevelCount));
}

#ifdef SLUICE_FEEDBACK_QUERY
/* How far two evaluations of the same level of detail may lie apart: a step of its fraction. */
#define SLUICE_QUERY_MARGIN (1.0 / 256.0)

/**
 * The level that the device itself says it will take, for sluiceWriteFeedbackQueried: neither
 * clamped nor rounded. Fragment shaders only, in uniform control flow, and best before any branch.
 *
 * Where the pixels of a quad disagree the finest of a pixel and its two neighbours counts. Mostly
 * they agree, and the differences are there for compilers: a query that only a branch uses must not
 * be moved into that branch, where the neighbours are missing.
 */
float sluiceQueryLod(sampler2D tex, vec2 uv)
{
    float lod = textureQueryLod(tex, uv).y;
    float spread = abs(dFdxFine(lod)) + abs(dFdyFine(lod));
    return spread > 0.0 ? lod - spread : lod; /* NaN stays what it is in this pixel alone */
}

/**
 * The same as sluiceWriteFeedback with the level that the device itself says it will take, for
 * comparison: it needs no margin for other formulas, but a texture and derivatives, so that it costs
 * every pixel what sluiceWriteFeedback costs the selected ones. `lod` is what sluiceQueryLod
 * said before the pixel was selected, with the whole texture that is streamed and the sampler that
 * it is sampled with. In paged residency no device takes the level: there it is the computed one.
 * Define SLUICE_FEEDBACK_QUERY to have it.
 *
 * With anisotropy the finer of this level and the computed one counts: where derivatives exceed
 * maxAnisotropy, a widely used driver names levels half of its logarithm coarser than it samples.
 */
void sluiceWriteFeedbackQueried(float lod, uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                                float maxAnisotropy)
{
#ifdef SLUICE_PAGED
    if (SLUICE_PAGED) {
        sluiceWriteFeedback(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
        return;
    }
#endif
    if (!sluiceTakesPart(tableIndex))
        return;
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    vec2 size = vec2(entry.width, entry.height);
    vec2 lods = sluiceComputeLods(dx * size, dy * size, lodBias, maxAnisotropy);
    bool known = lod == lod && sluiceIsFinite(uv);
    lod = known ? sluiceClampLod(lod + sluiceClampLodBias(lodBias)) : SLUICE_LOD_LIMIT;
    float finest = lod - SLUICE_QUERY_MARGIN;
    if (known && maxAnisotropy > 1.0)
        finest = min(finest, lods.x - sluiceLodMargin(maxAnisotropy));
    /* sample.glsl looks as far around as the computed level may reach */
    float widest = known ? max(lod + SLUICE_QUERY_MARGIN, lods.y) : lod;
    sluiceMarkSample(entry, uv, dx, dy, lodBias, maxAnisotropy,
                     sluiceFinestLevel(finest, 0.0, entry.mipLevelCount),
                     sluiceCoarsestLevel(widest, entry.mipLevelCount));
}

/** Both in one, in uniform control flow, with `selected` in place of a branch around it. */
void sluiceWriteFeedbackQuery(sampler2D tex, uint tableIndex, vec2 uv, float lodBias,
                              float maxAnisotropy, bool selected)
{
    float lod = sluiceQueryLod(tex, uv);
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    if (selected)
        sluiceWriteFeedbackQueried(lod, tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
}
#endif

#endif
