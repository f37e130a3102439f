/** Ordinary 2D images, fully backed by memory. */
#ifndef SLC_VULKAN_PLAIN_IMAGE_H
#define SLC_VULKAN_PLAIN_IMAGE_H

#include "vulkan/image_memory.h"
#include "vulkan/image_use.h"

struct slc_plain_image {
    VkImage image;
    bool storage; ///< shaders can store to it
    struct slc_image_place place;
};

/**
 * Creates an image of the levels of `info` from `first_level` on, with `layer_count` layers.
 * Shaders can store to a produced image, if the device supports that for the format. Errors:
 * UNSUPPORTED, with a log message; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 */
SluiceResult slc_plain_image_create(struct slc_plain_image *image, struct slc_image_memory *memory,
                                    const struct slc_vk *vk, const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb,
                                    const SluiceImageInfo *info, uint32_t first_level,
                                    uint32_t layer_count, const struct slc_image_use *use);
/** Destroys an image. It may be zeroed. */
void slc_plain_image_destroy(struct slc_plain_image *image, struct slc_image_memory *memory,
                             const struct slc_vk *vk, const SluiceAllocationCallbacks *cb);

#endif /* SLC_VULKAN_PLAIN_IMAGE_H */
