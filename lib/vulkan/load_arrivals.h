/** Reads that are over: texels have arrived, or the manager hears of the failure. */
#ifndef SLC_VULKAN_LOAD_ARRIVALS_H
#define SLC_VULKAN_LOAD_ARRIVALS_H

#include "vulkan/streamer.h"

/** Collects all reads that are over. */
SluiceResult slc_loads_collect(SluiceVulkanStreamer *s);
/** Ends the read of a tile with `answer`. */
SluiceResult slc_tile_back(SluiceVulkanStreamer *s, uint32_t unit, SluiceResult answer);
/** Ends one read of a texture's packed levels with `answer`. */
SluiceResult slc_packed_unit_back(SluiceVulkanStreamer *s, uint32_t unit, SluiceResult answer);

#endif /* SLC_VULKAN_LOAD_ARRIVALS_H */
