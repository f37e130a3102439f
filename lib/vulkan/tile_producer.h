/** The producer of a texture: checks its description, and makes image views for its stores. */
#ifndef SLC_VULKAN_TILE_PRODUCER_H
#define SLC_VULKAN_TILE_PRODUCER_H

#include "vulkan/residency.h"

struct slc_tile_producer {
    void *user;
    /** Records the tiles. NULL: there is no producer. */
    SluiceResult (*pfn)(void *user, const SluiceTileBatch *batch, SluiceResult *results);
    uint32_t timeout_frames;
};

/** Reads `given` and the image that it describes; 0 levels become the full chain. Errors, logged:
 *  NULL_POINTER, INVALID_ARGUMENT, UNSUPPORTED. */
SluiceResult slc_tile_producer_read(struct slc_tile_producer *producer, SluiceImageInfo *image,
                                    const SluiceTileProducer *given, const SluiceLogCallback *log);

/** Creates a view of each level of `image`, with all layers. `*views` stays NULL if shaders cannot
 *  store to the image. Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY; finish them then, too. */
SluiceResult slc_level_views_init(VkImageView **views, const struct slc_vk *vk,
                                  const SluiceAllocationCallbacks *cb,
                                  const struct slc_residency_image *image, VkFormat format,
                                  uint32_t layer_count);
void slc_level_views_finish(VkImageView **views, const struct slc_vk *vk,
                            const SluiceAllocationCallbacks *cb,
                            const struct slc_residency_image *image);

#endif /* SLC_VULKAN_TILE_PRODUCER_H */
