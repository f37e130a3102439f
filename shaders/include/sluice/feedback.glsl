/*
 * Writes down which level a sample wants, whether it is resident or not.
 *
 * Select few pixels first (stochastic.glsl), and take the derivatives before that branch:
 *
 *     vec2 dx = dFdx(uv), dy = dFdy(uv);
 *     if (sluiceSelectRandomQuad(uvec2(gl_FragCoord.xy), seed, 1.0 / 16.0))
 *         sluiceWriteFeedback(tableIndex, uv, dx, dy, 0.0, 8.0);
 *
 * A texture set writes once, with the primary's index.
 */
#ifndef SLUICE_FEEDBACK_GLSL
#define SLUICE_FEEDBACK_GLSL

#include "buffers.glsl"
#include "footprint.glsl"
#include "lod.glsl"

void sluiceMarkRegion(SluiceTextureEntry entry, uint x, uint y, uint level)
{
    uint at = entry.feedbackOffset + y * entry.regionCountX + x;
    /* Most writes change nothing, and a load is far cheaper than an atomic. */
    if (level < SLUICE_FEEDBACK_WORD(at))
        atomicMin(SLUICE_FEEDBACK_WORD(at), level);
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

/**
 * Marks every region that a sample at `uv` touches with the finest level that it may touch there.
 * `dx` and `dy` are the derivatives of `uv` per pixel; bias and anisotropy as the sample has them
 * (1: none). `uv` and derivatives that are not finite, and a bias that is NaN, mark the coarsest level
 * alone. Never writes outside the texture's own map. Helper invocations write nothing.
 */
void sluiceWriteFeedback(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                         float maxAnisotropy)
{
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    vec2 size = vec2(entry.width, entry.height);
    vec2 lods = sluiceIsFinite(uv) ? sluiceComputeLods(dx * size, dy * size, lodBias, maxAnisotropy)
                                   : vec2(SLUICE_LOD_LIMIT);
    uint level = sluiceFinestLevel(lods.x, sluiceLodMargin(maxAnisotropy), entry.mipLevelCount);
    uint coarsest = sluiceCoarsestLevel(lods.y, entry.mipLevelCount);
    vec2 halfBox = sluiceHalfBox(dx, dy, lodBias, maxAnisotropy);
    SluiceFootprint at = sluiceComputeFootprint(entry, uv, halfBox, coarsest);
    sluiceMarkFootprint(entry, at, level);
    if (!(maxAnisotropy > 1.0))
        return;
    /* Some devices read levels up to those without anisotropy, which reach further: docs/feedback.md. */
    uint widest = sluiceCoarsestLevel(sluiceComputeLod(dx * size, dy * size, lodBias, 1.0),
                                      entry.mipLevelCount);
    if (widest > coarsest)
        sluiceMarkFootprint(entry, sluiceComputeFootprint(entry, uv, halfBox, widest),
                            coarsest + 1u);
}

/** The same for textureLod: the level is given, and there is no anisotropy. NaN is the coarsest. */
void sluiceWriteFeedbackLod(uint tableIndex, vec2 uv, float lod)
{
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    lod = sluiceIsFinite(uv) ? sluiceClampLod(lod) : SLUICE_LOD_LIMIT;
    SluiceFootprint at = sluiceComputeFootprint(entry, uv, vec2(0.0),
                                                sluiceCoarsestLevel(lod, entry.mipLevelCount));
    sluiceMarkFootprint(entry, at, sluiceFinestLevel(lod, 0.0, entry.mipLevelCount));
}

#endif
