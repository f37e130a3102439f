/*
 * Records the levels that jittered samples (jitter.glsl) of streamed textures want.
 *
 * If every sample writes feedback, feedback.glsl at the jittered position suffices. If few pixels write
 * feedback, call the function below instead: it marks the tiles of all offsets at once, so that the
 * wanted tiles do not depend on random numbers.
 *
 * Include it after the definitions of buffers.glsl and feedback.glsl.
 */
#ifndef SLUICE_FEEDBACK_JITTER_GLSL
#define SLUICE_FEEDBACK_JITTER_GLSL

#include "feedback.glsl"
#include "jitter.glsl"

/**
 * Marks every region that a sample at sluiceJitter touches for any random numbers, with the finest
 * level touched there. Arguments: as for sluiceWriteFeedback, without jitter.
 */
void sluiceWriteJitteredFeedback(uint tableIndex, vec2 uv, vec2 dx, vec2 dy, float lodBias,
                                 float maxAnisotropy, uint kernel)
{
    if (!sluiceTakesPart(tableIndex))
        return;
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uint first = SLUICE_TEXTURE_ENTRY(tableIndex).feedbackOffset;
    dx *= grid.size;
    dy *= grid.size;
    float texel = sluiceJitterTexel(sluiceComputeLod(dx, dy, lodBias, maxAnisotropy), grid.size);
    uvec3 levels = sluiceMarkedLevels(grid, uv, dx, dy, lodBias, maxAnisotropy);
    vec2 halfBox = sluiceHalfBox(dx, dy, lodBias, maxAnisotropy) + sluiceJitterReach(kernel) * texel;
    sluiceMarkBox(first, grid, uv, halfBox, levels.x, levels.y);
    if (maxAnisotropy > 1.0 && levels.z > levels.y)
        sluiceMarkBox(first, grid, uv, halfBox, levels.y + 1u, levels.z);
}

#endif
