/**
 * Device-local memory of ordinary images: small ones share blocks, because devices bound the number
 * of allocations; large ones have their own.
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

/** Zeroed: an empty one, for images that are resident as a whole. */
struct slc_image_memory {
    SluiceDeviceMemoryPurpose purpose;
    struct slc_image_block *blocks; ///< owned
    uint32_t block_capacity;
    uint32_t last;       ///< block that had room last
    uint64_t total_size; ///< bytes allocated
    bool quiet;          ///< logs no memory that the driver refuses
};

/** Where an image lies; zeroed: nowhere. */
struct slc_image_place {
    struct slc_memory own; ///< of a large image
    uint32_t block;        ///< of a small one
    uint32_t first, count; ///< units; count 0: not in a block
};

/** Allocates and binds. Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN; nothing changed.
 */
SluiceResult slc_image_memory_bind(struct slc_image_memory *pool, const struct slc_vk *vk,
                                   const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                   VkImage image, struct slc_image_place *place);
/** After the image was destroyed. */
void slc_image_memory_release(struct slc_image_memory *pool, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb, struct slc_image_place *place);
/** Everything was released. */
void slc_image_memory_finish(struct slc_image_memory *pool, const SluiceAllocationCallbacks *cb);

#endif /* SLC_VULKAN_IMAGE_MEMORY_H */
