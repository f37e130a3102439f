/**
 * Logs once that a memory budget cannot be met: more memory is in use than it allows, and the
 * memory in use has not shrunk for many frames.
 */
#ifndef SLC_VULKAN_UNMET_BUDGET_H
#define SLC_VULKAN_UNMET_BUDGET_H

#include "vulkan/streamer.h"

/** Counts a frame. Call it when a frame begins, after memory_pressure is known. */
void slc_unmet_budget_step(SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_UNMET_BUDGET_H */
