/**
 * Gives heaps back to the device, if the budget or another front end needs their memory or the
 * application asks for it. The tiles of the least used heap are evicted. Wanted tiles are read
 * again into fuller heaps. The empty heap is released, and freed when the GPU has finished with it.
 */
#ifndef SLC_VULKAN_SHRINK_H
#define SLC_VULKAN_SHRINK_H

#include "vulkan/streamer.h"

/** Empties and releases heaps. Call it when a frame begins, after completed work is collected. */
SluiceResult slc_shrink_step(SluiceVulkanStreamer *s);

/** Sets the manager's configuration. Takes a targetHeapCount that the application has set for its
 * own target, even if it is equal to the target that memory pressure set. */
SluiceResult slc_shrink_set_config(SluiceVulkanStreamer *s,
                                   const SluiceStreamedTextureManagerConfig *config);

#endif /* SLC_VULKAN_SHRINK_H */
