/** Reads that have ended: units with texels, or failures reported to the manager. */
#ifndef SLC_VULKAN_LOAD_ARRIVALS_H
#define SLC_VULKAN_LOAD_ARRIVALS_H

#include "vulkan/streamer.h"

/** Collects all reads that have ended. */
SluiceResult slc_loads_collect(SluiceVulkanStreamer *s);
/** Ends the read of a tile with `answer`. */
SluiceResult slc_tile_back(SluiceVulkanStreamer *s, uint32_t unit, SluiceResult answer);
/** Ends one read of a texture's packed levels with `answer`. */
SluiceResult slc_packed_unit_back(SluiceVulkanStreamer *s, uint32_t unit, SluiceResult answer);

/** Frees the packed units of a texture after one of them failed (packed_result). All of them are
 *  back. Nothing is bound, and the manager tries again later. */
SluiceResult slc_packed_fail(SluiceVulkanStreamer *s, uint32_t texture);

/** True while at least half of the units are free. A load that is not ready may then keep its unit.
 *  Otherwise it fails, and the manager asks again later. */
bool slc_loads_can_wait(const SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_LOAD_ARRIVALS_H */
