/** Reports of misuse. Each function does nothing unless strict mode is on. */
#ifndef SLC_VULKAN_STRICT_MODE_H
#define SLC_VULKAN_STRICT_MODE_H

#include "vulkan/streamer.h"

void slc_strict_not_ended(SluiceVulkanStreamer *s);
void slc_strict_not_begun(SluiceVulkanStreamer *s);
/** Counts a begin that returned SLUICE_NOT_READY because `frame` is not complete. */
void slc_strict_not_ready(SluiceVulkanStreamer *s, uint64_t frame);
/** Checks the decisions of a frame that has begun. */
void slc_strict_begun(SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_STRICT_MODE_H */
