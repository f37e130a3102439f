/** Texel formats in Vulkan's words. */
#ifndef SLC_VULKAN_FORMAT_H
#define SLC_VULKAN_FORMAT_H

#include <sluice/vulkan.h>

/** Returns the Vulkan format; VK_FORMAT_UNDEFINED for formats that Vulkan does not have. */
VkFormat slc_vk_format(SluiceFormat format);

#endif /* SLC_VULKAN_FORMAT_H */
