/** Uses of a streamed texture's image by the application, besides sampling. */
#ifndef SLC_VULKAN_IMAGE_USE_H
#define SLC_VULKAN_IMAGE_USE_H

#include "vulkan/dispatch.h"

#define SLC_MAX_VIEW_FORMATS 16u

/** Uses of an image. Zeroed: it is only sampled. */
struct slc_image_use {
    bool produced;           ///< shaders may store to it
    bool mutable_format;     ///< the application makes views of other formats
    const VkFormat *formats; ///< formats of these views; borrowed
    uint32_t format_count;   ///< at most SLC_MAX_VIEW_FORMATS; 0: any compatible format
};

/** Arrays that a VkImageCreateInfo points to. */
struct slc_image_formats {
    VkImageFormatListCreateInfo list;
    VkFormat formats[SLC_MAX_VIEW_FORMATS + 1];
};

/** Adds flags and view formats for mutable_format to `create`, whose format is set. If there is a
 *  list of formats, `create` points to `formats` afterwards. */
void slc_image_use_apply(const struct slc_image_use *use, VkImageCreateInfo *create,
                         struct slc_image_formats *formats);

/** Checks the formats of a texture's create-info. Errors: NULL_POINTER; INVALID_ARGUMENT, with a
 *  log message. */
SluiceResult slc_image_use_init(struct slc_image_use *use, const SluiceLogCallback *log,
                                const SluiceVulkanTextureCreateInfo *info);

#endif /* SLC_VULKAN_IMAGE_USE_H */
