/** Texel formats in Vulkan's words. */
#ifndef SLC_VULKAN_FORMAT_H
#define SLC_VULKAN_FORMAT_H

#include <sluice/vulkan.h>

/** VK_FORMAT_UNDEFINED for formats that have no counterpart. */
VkFormat slc_vk_format(SluiceFormat format);

#endif /* SLC_VULKAN_FORMAT_H */
