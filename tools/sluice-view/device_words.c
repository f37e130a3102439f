#include "device_words.h"

#include <stdio.h>

struct quirks {
    char (*words)[DEVICE_WORDS];
    uint32_t count;
};

static void add(struct quirks *quirks, bool holds, const char *words)
{
    if (holds && quirks->count < DEVICE_QUIRKS)
        snprintf(quirks->words[quirks->count++], DEVICE_WORDS, "%s", words);
}

uint32_t device_quirks(const SluiceVulkanDeviceCapabilities *c, SluiceResidencyMode mode,
                       char words[DEVICE_QUIRKS][DEVICE_WORDS])
{
    const bool sparse = mode == SLUICE_RESIDENCY_MODE_SPARSE;
    const bool paged = mode == SLUICE_RESIDENCY_MODE_PAGED;
    struct quirks quirks = {words, 0};
    if (sparse && c->maxTouchedTiles > 0)
        snprintf(words[quirks.count++], DEVICE_WORDS,
                 "At most %u tiles are ever bound in living images: the driver keeps a memory map "
                 "for each (maxTouchedTiles).",
                 c->maxTouchedTiles);
    add(&quirks, sparse && c->shaderResourceResidency && !c->residencyCodesExact,
        "Residency codes are wrong between levels; shaders use MinMip maps alone "
        "(residencyCodesExact).");
    add(&quirks, sparse && !c->residencyNonResidentStrict,
        "Texels without memory read as anything (residencyNonResidentStrict).");
    add(&quirks, sparse && !c->sparseCubes,
        "Cube maps cannot be streamed in sparse mode (sparseCubes).");
    add(&quirks, sparse && !c->standardTiles,
        "Tiles have other shapes than the standard ones (standardTiles).");
    add(&quirks, sparse && !c->dedicatedSparseQueue,
        "Tiles are bound on a queue that can draw, too (dedicatedSparseQueue).");
    add(&quirks, sparse && !c->shaderResourceMinLod,
        "Samplers take no clamp of the level of detail (shaderResourceMinLod).");
    add(&quirks, paged && (!c->nonUniformIndexing || !c->runtimeDescriptorArrays),
        "Shaders look for pages in a loop (SLUICE_PAGE_LOOP).");
    add(&quirks, !c->textureCompressionBC, "BC formats cannot be streamed (textureCompressionBC).");
    add(&quirks, c->timestampPeriod <= 0, "The GPU has no time stamps (timestampPeriod).");
    return quirks.count;
}

const char *device_mode_reason(const SluiceVulkanDeviceCapabilities *c, SluiceResidencyMode asked,
                               SluiceResidencyMode mode, uint32_t texture_count,
                               char words[DEVICE_WORDS])
{
    if (asked != SLUICE_RESIDENCY_MODE_AUTO)
        snprintf(words, DEVICE_WORDS, "It was asked for (--residency).");
    else if (mode == SLUICE_RESIDENCY_MODE_SPARSE && c->maxTouchedTiles > 0)
        snprintf(words, DEVICE_WORDS,
                 "The device has sparse residency, and %u textures are few enough for the %u tiles "
                 "that it can bind.",
                 texture_count, c->maxTouchedTiles);
    else if (mode == SLUICE_RESIDENCY_MODE_SPARSE)
        snprintf(words, DEVICE_WORDS, "The device has sparse residency and a queue that binds.");
    else if (!c->sparse)
        snprintf(words, DEVICE_WORDS, "The device has no sparse residency of 2D images.");
    else
        snprintf(words, DEVICE_WORDS,
                 "%u textures are too many for the %u tiles that this device can bind.",
                 texture_count, c->maxTouchedTiles);
    return words;
}
