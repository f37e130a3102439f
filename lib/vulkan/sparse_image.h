/** Sparse images: creation, layout as reported by the driver, and pages of the metadata. */
#ifndef SLC_VULKAN_SPARSE_IMAGE_H
#define SLC_VULKAN_SPARSE_IMAGE_H

#include "vulkan/caps.h"
#include "vulkan/image_use.h"
#include "vulkan/memory.h"
#include "vulkan/sparse_layout.h"
#include "vulkan/touched_tiles.h"

/** A sparse image, or one layer of an array: layers are places in one VkImage. */
struct slc_sparse_image {
    VkImage image; ///< owned by the first layer
    bool storage;  ///< shaders can store to it
    struct slc_sparse_layout layout;
    uint32_t layer, layer_count;
    struct slc_memory metadata;       ///< owned by the first layer; zeroed if there is none
    bool metadata_bound;              ///< the metadata of this layer is bound
    struct slc_touched_tiles touched; ///< used by the residency
    uint64_t last_value;              ///< value of the last batch with binds of the image
    uint32_t unmap_count;             ///< unmaps that are not in a batch yet
};

/**
 * Creates info->arrayLayerCount `images`, one for 0. Shaders can store to produced images, if the
 * device supports that for the format. Errors: UNSUPPORTED, with a log message, or with the reason
 * in `refusal` if that is not NULL; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY.
 */
SluiceResult slc_sparse_image_create(struct slc_sparse_image *images, const struct slc_vk *vk,
                                     const struct slc_caps *caps, uint32_t memory_type,
                                     const SluiceImageInfo *info, const struct slc_image_use *use,
                                     const char **refusal);
/** Destroys all layers of an image. `images` points to the first one. */
void slc_sparse_image_destroy(struct slc_sparse_image *images, const struct slc_vk *vk);

/** Gets a device-local memory type for sparse images. Errors: as slc_sparse_image_create. */
SluiceResult slc_sparse_memory_type(const struct slc_vk *vk, const struct slc_caps *caps,
                                    uint32_t *memory_type);

#endif /* SLC_VULKAN_SPARSE_IMAGE_H */
