/**
 * Heaps go back to the device: when the budget or another front end needs their memory, or the
 * application asks for it. Tiles of the least used heap are evicted, and read again into fuller
 * heaps if they are wanted; the empty heap is released, and freed when the GPU is done with it.
 */
#ifndef SLC_VULKAN_SHRINK_H
#define SLC_VULKAN_SHRINK_H

#include "vulkan/streamer.h"

/** A frame begins, and what the GPU has finished is known: heaps are released, or made empty. */
SluiceResult slc_shrink_step(SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_SHRINK_H */
