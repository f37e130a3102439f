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

/** All packed units are back and packed_result says that one of them failed: frees them. Nothing is
 *  bound, and the manager tries again later. */
SluiceResult slc_packed_fail(SluiceVulkanStreamer *s, uint32_t texture);

/** Sources that are not ready may hold half of the units. The others are for sources that are: what
 *  is not ready then fails, and the manager asks again later. */
bool slc_loads_can_wait(const SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_LOAD_ARRIVALS_H */
