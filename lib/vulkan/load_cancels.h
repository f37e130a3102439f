/** Cancellation of loads that are not wanted any more. */
#ifndef SLC_VULKAN_LOAD_CANCELS_H
#define SLC_VULKAN_LOAD_CANCELS_H

#include "vulkan/streamer.h"

SluiceResult slc_loads_cancel(SluiceVulkanStreamer *s);
/** Drops all loads of a texture that is being removed. */
void slc_loads_drop(SluiceVulkanStreamer *s, uint32_t texture);

#endif /* SLC_VULKAN_LOAD_CANCELS_H */
