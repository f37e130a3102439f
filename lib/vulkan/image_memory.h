/**
 * Device-local memory of ordinary images. Small images share blocks, because devices limit the
 * number of allocations. Large images have allocations of their own.
 */
#ifndef SLC_VULKAN_IMAGE_MEMORY_H
#define SLC_VULKAN_IMAGE_MEMORY_H

#include "vulkan/caps.h"
#include "vulkan/memory.h"
#include "vulkan/region_arena.h"

struct slc_image_block {
    struct slc_memory memory; ///< none: free
    uint32_t type;
    struct slc_region_arena arena; ///< in units of 256 bytes
    uint32_t used;                 ///< images
};

/** Memory of images. Zeroed: empty, for images that are resident as a whole. */
struct slc_image_memory {
    SluiceDeviceMemoryPurpose purpose;
    struct slc_image_block *blocks; ///< owned
    uint32_t block_capacity;
    uint32_t last;       ///< block of the last image, searched first
    uint64_t total_size; ///< bytes allocated
    bool quiet;          ///< does not log allocations that the driver refuses
};

/** Memory of one image. Zeroed: none. */
struct slc_image_place {
    struct slc_memory own; ///< memory of a large image
    uint32_t block;        ///< block of a small image
    uint32_t first, count; ///< units of 256 bytes in the block; count 0: not in a block
};

/** Allocates memory for an image and binds it. Errors, with nothing changed: OUT_OF_HOST_MEMORY,
 * OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_image_memory_bind(struct slc_image_memory *pool, const struct slc_vk *vk,
                                   const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                   VkImage image, struct slc_image_place *place);
/** Releases the memory of an image. Destroy the image first. */
void slc_image_memory_release(struct slc_image_memory *pool, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb, struct slc_image_place *place);
/** Finishes the pool. All images must be released. */
void slc_image_memory_finish(struct slc_image_memory *pool, const SluiceAllocationCallbacks *cb);

#endif /* SLC_VULKAN_IMAGE_MEMORY_H */
