/** Capabilities of a device for one format. */
#ifndef SLC_VULKAN_FORMAT_CAPS_H
#define SLC_VULKAN_FORMAT_CAPS_H

#include "vulkan/dispatch.h"

/** Usage of streamed images. */
#define SLC_IMAGE_USAGE (VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT)
#define SLC_IMAGE_SPARSE_FLAGS                                                                     \
    (VK_IMAGE_CREATE_SPARSE_BINDING_BIT | VK_IMAGE_CREATE_SPARSE_RESIDENCY_BIT)

/** Flags of an image of any residency mode. */
static inline VkImageCreateFlags slc_image_flags(const SluiceImageInfo *info)
{
    return info->cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
}

/** Gets the capabilities of a format; all zero for formats that Vulkan does not have. Uses only
 * instance functions. */
void slc_format_caps_init(SluiceVulkanFormatCapabilities *caps, const struct slc_vk *vk,
                          SluiceFormat format);

/** True if the device can sample the format with LINEAR filters. */
bool slc_filters_linear(const struct slc_vk *vk, SluiceFormat format);

/** Returns the width of the largest sparse cube map, in texels. 0: the device supports none. */
uint32_t slc_max_sparse_cube_width(const struct slc_vk *vk, SluiceFormat format);

/** True if the device supports the image with `usage` added. */
bool slc_image_is_supported(const struct slc_vk *vk, const VkImageCreateInfo *image,
                            VkImageUsageFlags usage);

/** True if the device supports the image with VK_IMAGE_USAGE_STORAGE_BIT added. */
bool slc_image_may_store(const struct slc_vk *vk, const VkImageCreateInfo *image);

#endif /* SLC_VULKAN_FORMAT_CAPS_H */
