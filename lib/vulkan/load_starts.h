/** Starts loads: tiles that the manager hands out, and packed levels as a whole. */
#ifndef SLC_VULKAN_LOAD_STARTS_H
#define SLC_VULKAN_LOAD_STARTS_H

#include "vulkan/streamer.h"

SluiceResult slc_loads_start(SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_LOAD_STARTS_H */
