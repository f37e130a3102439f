/**
 * Calls of vkQueueBindSparse with a limited number of regions.
 *
 * Calls are ordered by a timeline semaphore only: a later call may rebind tiles that an earlier
 * call unbinds. Each call waits for the value of the call before it, and signals the next value.
 */
#ifndef SLC_VULKAN_BIND_CALLS_H
#define SLC_VULKAN_BIND_CALLS_H

#include "vulkan/dispatch.h"

struct slc_bind_calls_limits {
    uint32_t regions_per_call; ///< at least 1
    uint32_t tile_count, page_count;
    uint32_t image_count;
};

struct slc_bind_calls {
    const struct slc_vk *vk;
    VkQueue queue;
    VkSemaphore semaphore; ///< owned
    uint64_t signaled;     ///< value of the semaphore after the last call
    uint64_t count;        ///< calls
    struct slc_bind_calls_limits limits;

    /* The next call: owned arrays and their counts. */
    VkSparseImageMemoryBind *tiles;
    VkSparseMemoryBind *pages;
    VkSparseImageMemoryBindInfo *tile_images;
    VkSparseImageOpaqueMemoryBindInfo *page_images;
    uint32_t tile_count, page_count, tile_image_count, page_image_count;
};

/** Creates the semaphore and arrays. Errors: OUT_OF_HOST_MEMORY, those of vkCreateSemaphore. Finish
 * it after an error, too. */
SluiceResult slc_bind_calls_init(struct slc_bind_calls *calls, const struct slc_vk *vk,
                                 VkQueue queue, const SluiceAllocationCallbacks *cb,
                                 const struct slc_bind_calls_limits *limits);
void slc_bind_calls_finish(struct slc_bind_calls *calls, const SluiceAllocationCallbacks *cb);

/** Begins a batch. Forgets regions of a batch that failed. */
void slc_bind_calls_begin(struct slc_bind_calls *calls);
/** Adds a region, after a call if one is full. Regions of one image follow each other. */
SluiceResult slc_bind_calls_add_tile(struct slc_bind_calls *calls, VkImage image,
                                     const VkSparseImageMemoryBind *bind);
SluiceResult slc_bind_calls_add_page(struct slc_bind_calls *calls, VkImage image,
                                     const VkSparseMemoryBind *bind);
/** Makes the last call of a batch. The batch is over when the semaphore stands at `signaled`. */
SluiceResult slc_bind_calls_end(struct slc_bind_calls *calls);

#endif /* SLC_VULKAN_BIND_CALLS_H */
