/*
 * Decodes texels of a neural set whose latents are byte pages of a demand loader (sluice/neural_pages.h),
 * and requests the page of a texel that is missing: the chosen texel is all the feedback.
 *
 *     float channels[SLUICE_NEURAL_CHANNELS];
 *     uint shown; // mip, at least pick.level
 *     if (sluiceNeuralSampleOrRequest(s, pick.texel, pick.level, shown, channels))
 *         shade(channels);
 *
 * The resource has addresses: SluiceDemandLoaderCreateInfo.bufferDeviceAddress, and no byteOffsets. Before
 * this file, include demand_bindings.glsl (or define the macros of demand_pages.glsl), and
 *
 *     #extension GL_EXT_buffer_reference_uvec2 : require
 *     #include "sluice/shared/neural_pages.h"                          // to declare blocks with the structs
 *     #define SLUICE_NEURAL_PAGES(s) sets[s]                           // SluiceNeuralPages, read
 *     #define SLUICE_NEURAL_FIRST_PAGE(s) first_pages[s]               // uint, of sluiceAddDemandResource
 *     #define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights.words[first + i] // see neural.glsl
 *
 * Keep the pages of the last group pinned (sluiceSetDemandPageBytes), or preload them: then there is
 * always a mip to show.
 */
#ifndef SLUICE_NEURAL_PAGES_GLSL
#define SLUICE_NEURAL_PAGES_GLSL

#include "demand_pages.glsl"
#include "shared/neural_pages.h"

/* A page: constants of its rectangle, then its latents. */
layout(std430, buffer_reference, buffer_reference_align = 16) readonly buffer SluiceNeuralPage {
    SluiceNeuralConstants constants;
    uint latents[];
};

/* Address of the page to decode. */
uvec2 sluiceNeuralAddress = uvec2(0u);

#define SLUICE_NEURAL_CONSTANTS(s) SluiceNeuralPage(sluiceNeuralAddress).constants
#define SLUICE_NEURAL_LATENT_WORD(s, i) SluiceNeuralPage(sluiceNeuralAddress).latents[i]
#include "neural.glsl"

/** Returns the group of the mips that share latents with a mip. */
uint sluiceNeuralGroup(uint s, uint mip)
{
    uint g = 0u;
    while (g + 1u < SLUICE_NEURAL_PAGES(s).groupCount && mip >= SLUICE_NEURAL_PAGES(s).groups[g + 1u].firstMip)
        g++;
    return g;
}

/** Returns the page of a texel, among the pages of the set. */
uint sluiceNeuralPageOf(uint s, uint group, uvec2 texel, uint mip)
{
    uvec2 at = texel << (mip - SLUICE_NEURAL_PAGES(s).groups[group].firstMip);
    at /= uvec2(SLUICE_NEURAL_PAGES(s).groups[group].pageWidth, SLUICE_NEURAL_PAGES(s).groups[group].pageHeight);
    return SLUICE_NEURAL_PAGES(s).groups[group].firstPage + at.y * SLUICE_NEURAL_PAGES(s).groups[group].columns +
           at.x;
}

/**
 * Decodes a texel, or the texel over it in the finest resident mip; `shown` is the decoded mip. Requests
 * the texel's page if missing, and also the coarsest page if all are missing.
 *
 * False, and all channels 0, if no page is resident or the texel does not exist.
 */
bool sluiceNeuralSampleOrRequest(uint s, ivec2 texel, uint mip, out uint shown,
                                 out float channels[SLUICE_NEURAL_CHANNELS])
{
    for (uint i = 0u; i < SLUICE_NEURAL_CHANNELS; i++)
        channels[i] = 0.0;
    shown = mip;
    uvec2 size = uvec2(SLUICE_NEURAL_PAGES(s).width, SLUICE_NEURAL_PAGES(s).height);
    if (mip >= SLUICE_NEURAL_PAGES(s).mipCount || any(lessThan(texel, ivec2(0))) ||
        any(greaterThanEqual(uvec2(texel), max(size >> mip, uvec2(1u)))))
        return false;
    uint wanted = sluiceNeuralGroup(s, mip), count = SLUICE_NEURAL_PAGES(s).groupCount;
    for (uint g = wanted; g < count; g++) {
        uint first = SLUICE_NEURAL_PAGES(s).groups[g].firstMip;
        shown = max(mip, first);
        uvec2 at = min(uvec2(texel) >> (shown - mip), max(size >> shown, uvec2(1u)) - 1u);
        uint page = SLUICE_NEURAL_FIRST_PAGE(s) + sluiceNeuralPageOf(s, g, at, shown), word, index;
        if (sluiceFindDemandPage(page, index, word)) {
            sluiceNeuralAddress = uvec2(word, SLUICE_DEMAND_BLOCK_WORD(index + SLUICE_DEMAND_BLOCK_PAGES));
            return sluiceNeuralSample(s, ivec2(at), shown, channels);
        }
        if (g == wanted || g + 1u == count)
            sluiceRequestDemandPage(page);
    }
    return false;
}

#endif
