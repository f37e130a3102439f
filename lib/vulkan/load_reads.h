/** Which texels a unit reads. */
#ifndef SLC_VULKAN_LOAD_READS_H
#define SLC_VULKAN_LOAD_READS_H

#include "vulkan/streamer.h"

/** Gives the unit to the tile loader; again, if its source was not ready. */
SluiceResult slc_unit_submit(SluiceVulkanStreamer *s, uint32_t unit);

#endif /* SLC_VULKAN_LOAD_READS_H */
