#include "vulkan/source_uses.h"

#include <sluice/vulkan_control.h>

static bool is_used(const SluiceVulkanStreamer *s, const SluiceImageSource *source)
{
    for (uint32_t i = 0; i < s->texture_high; i++)
        if (s->textures[i].state == SLC_TEXTURE_LIVE && s->textures[i].source == source)
            return true;
    for (uint32_t i = 0; i < s->info.maxLoadsInFlight; i++)
        if (s->units[i].state == SLC_UNIT_READING && s->units[i].source == source)
            return true;
    return false;
}

void slc_source_left(SluiceVulkanStreamer *s, const SluiceImageSource *source)
{
    if (source && !is_used(s, source))
        sluiceDropTileLoaderStatistics(s->loader, source);
}

SluiceResult sluiceIsVulkanSourceInUse(const SluiceVulkanStreamer *streamer,
                                       const SluiceImageSource *source, bool *pInUse)
{
    if (!streamer || !source || !pInUse)
        return SLUICE_ERROR_NULL_POINTER;
    *pInUse = is_used(streamer, source);
    return SLUICE_SUCCESS;
}
