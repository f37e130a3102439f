/** Image views of one texture, or of one layer of an array. */
#ifndef SLC_VULKAN_TEXTURE_VIEWS_H
#define SLC_VULKAN_TEXTURE_VIEWS_H

#include "vulkan/dispatch.h"

/** Views of a texture. Missing ones are VK_NULL_HANDLE, so a zeroed struct can be finished. */
struct slc_texture_views {
    VkImageView layer;      ///< 2D
    VkImageView array;      ///< 2D_ARRAY; owned by layer 0 of an array
    VkImageView cube;       ///< owned by the first face of each cube
    VkImageView cube_array; ///< owned by layer 0 of more than one cube
};

/**
 * Creates the views that layer `layer` of `info->arrayLayerCount` owns. All views have all levels
 * of `image`. `cube_arrays`: the device has the feature imageCubeArray. Finish them after an error,
 * too.
 *
 * Errors: OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 */
SluiceResult slc_texture_views_init(struct slc_texture_views *views, const struct slc_vk *vk,
                                    VkImage image, const SluiceImageInfo *info, uint32_t layer,
                                    bool cube_arrays);
void slc_texture_views_finish(struct slc_texture_views *views, const struct slc_vk *vk);

#endif /* SLC_VULKAN_TEXTURE_VIEWS_H */
