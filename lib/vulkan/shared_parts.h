/**
 * Threads and pages that the front ends of a context share. Made by the first front end, with its
 * settings, and destroyed with the last one.
 */
#ifndef SLC_VULKAN_SHARED_PARTS_H
#define SLC_VULKAN_SHARED_PARTS_H

#include "vulkan/context.h"
#include "vulkan/page_pool.h"

#include <sluice/loader.h>

/** Pages of the context. `chunk_count` counts if there are none yet. Errors: OUT_OF_HOST_MEMORY,
 *  OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_use_pages(SluiceVulkanContext *context, uint32_t chunk_count,
                           struct slc_page_pool **pool);
/** Ends what slc_use_pages began. NULL is allowed. */
void slc_drop_pages(SluiceVulkanContext *context, struct slc_page_pool *pool);

/** A tile loader on the context's threads. Number of threads, reads per source and bytes in flight
 *  count if there are no threads yet. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_create_shared_loader(SluiceVulkanContext *context,
                                      const SluiceTileLoaderCreateInfo *info,
                                      SluiceTileLoader **loader);
/** NULL is allowed. */
void slc_destroy_shared_loader(SluiceVulkanContext *context, SluiceTileLoader *loader);

#endif /* SLC_VULKAN_SHARED_PARTS_H */
