/** Sparse images: creation, what the driver says of their layout, and the pages of the metadata. */
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
    struct slc_memory metadata;       ///< as the image; zeroed where there is none
    bool metadata_bound;              ///< of this layer
    struct slc_touched_tiles touched; ///< the residency's business
    uint64_t last_value;              ///< of the last batch that names it
    uint32_t unmap_count;             ///< not yet in a batch
};

/**
 * Creates info->arrayLayerCount `images`, one for 0. Shaders can store to produced ones, if the
 * device can with this format. Errors: UNSUPPORTED, with a log message, or if `refusal` is not
 * NULL, with the reason there; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY.
 */
SluiceResult slc_sparse_image_create(struct slc_sparse_image *images, const struct slc_vk *vk,
                                     const struct slc_caps *caps, uint32_t memory_type,
                                     const SluiceImageInfo *info, const struct slc_image_use *use,
                                     const char **refusal);
/** `images` is the first layer; all of them go. */
void slc_sparse_image_destroy(struct slc_sparse_image *images, const struct slc_vk *vk);

/** Device-local memory that sparse images can be bound to. Errors: as above. */
SluiceResult slc_sparse_memory_type(const struct slc_vk *vk, const struct slc_caps *caps,
                                    uint32_t *memory_type);

#endif /* SLC_VULKAN_SPARSE_IMAGE_H */
