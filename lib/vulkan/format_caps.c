#include "vulkan/format_caps.h"

#include "base/struct_size.h"
#include "vulkan/caps.h"
#include "image/format_size.h"
#include "vulkan/format.h"
#include "vulkan/sparse_layout.h"

#define MAX_ASPECTS 4u

static bool get_limits(const struct slc_vk *vk, VkFormat format, VkImageCreateFlags flags,
                       SluiceVulkanFormatCapabilities *caps)
{
    VkImageFormatProperties limits;
    if (vk->GetPhysicalDeviceImageFormatProperties(vk->physical_device, format, VK_IMAGE_TYPE_2D,
                                                   VK_IMAGE_TILING_OPTIMAL, SLC_IMAGE_USAGE, flags,
                                                   &limits) != VK_SUCCESS)
        return false;
    caps->maxWidth = limits.maxExtent.width;
    caps->maxHeight = limits.maxExtent.height;
    caps->maxMipLevelCount = limits.maxMipLevels;
    caps->maxArrayLayerCount = limits.maxArrayLayers;
    caps->maxImageSize = limits.maxResourceSize;
    return true;
}

static bool get_granularity(const struct slc_vk *vk, VkFormat format, VkExtent3D *granularity)
{
    VkSparseImageFormatProperties aspects[MAX_ASPECTS];
    uint32_t count = MAX_ASPECTS;
    vk->GetPhysicalDeviceSparseImageFormatProperties(vk->physical_device, format, VK_IMAGE_TYPE_2D,
                                                     VK_SAMPLE_COUNT_1_BIT, SLC_IMAGE_USAGE,
                                                     VK_IMAGE_TILING_OPTIMAL, &count, aspects);
    for (uint32_t i = 0; i < count; i++) {
        if (!(aspects[i].aspectMask & VK_IMAGE_ASPECT_COLOR_BIT))
            continue;
        *granularity = aspects[i].imageGranularity;
        return true;
    }
    return false;
}

bool slc_filters_linear(const struct slc_vk *vk, SluiceFormat format)
{
    VkFormatProperties features;
    if (slc_format_is_integer(format)) /* Vulkan has no linear filter for integers */
        return false;
    vk->GetPhysicalDeviceFormatProperties(vk->physical_device, slc_vk_format(format), &features);
    return features.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
}

void slc_format_caps_init(SluiceVulkanFormatCapabilities *caps, const struct slc_vk *vk,
                          SluiceFormat format)
{
    *caps = (SluiceVulkanFormatCapabilities){.structSize = sizeof(SluiceVulkanFormatCapabilities)};
    VkFormat vk_format = slc_vk_format(format);
    SluiceFormatInfo info = {.structSize = sizeof info};
    VkExtent3D granularity;
    if (vk_format == VK_FORMAT_UNDEFINED || sluiceGetFormatInfo(format, &info) != SLUICE_SUCCESS)
        return;
    caps->linearFilter = slc_filters_linear(vk, format);
    caps->sampled = get_limits(vk, vk_format, 0, caps);
    if (!caps->sampled || !get_granularity(vk, vk_format, &granularity) ||
        !get_limits(vk, vk_format, SLC_IMAGE_SPARSE_FLAGS, caps))
        return;
    VkExtent3D tile = slc_sparse_tile_extent(&info, granularity);
    caps->granularityWidth = granularity.width;
    caps->granularityHeight = granularity.height;
    caps->tileWidth = tile.width;
    caps->tileHeight = tile.height;
    caps->sparse = tile.depth == 1 &&
                   sluiceGetFormatRegionSize(format, tile.width, tile.height) == SLC_TILE_SIZE;
}

uint32_t slc_max_sparse_cube_width(const struct slc_vk *vk, SluiceFormat format)
{
    SluiceVulkanFormatCapabilities caps = {.structSize = sizeof caps};
    return get_limits(vk, slc_vk_format(format),
                      SLC_IMAGE_SPARSE_FLAGS | VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT, &caps)
               ? caps.maxWidth
               : 0;
}

bool slc_image_is_supported(const struct slc_vk *vk, const VkImageCreateInfo *image,
                            VkImageUsageFlags usage)
{
    VkImageFormatProperties limits;
    return vk->GetPhysicalDeviceImageFormatProperties(
               vk->physical_device, image->format, image->imageType, image->tiling,
               image->usage | usage, image->flags, &limits) == VK_SUCCESS;
}

bool slc_image_may_store(const struct slc_vk *vk, const VkImageCreateInfo *image)
{
    return slc_image_is_supported(vk, image, VK_IMAGE_USAGE_STORAGE_BIT);
}

SluiceResult sluiceGetVulkanFormatCapabilities(VkInstance instance, VkPhysicalDevice physicalDevice,
                                               PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr,
                                               SluiceFormat format,
                                               SluiceVulkanFormatCapabilities *pCapabilities)
{
    if (!instance || !physicalDevice || !pfnGetInstanceProcAddr || !pCapabilities)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceVulkanFormatCapabilities), pCapabilities, NULL);
    if (checked != SLUICE_SUCCESS)
        return checked;
    struct slc_vk vk;
    SluiceResult result =
        slc_vk_init_instance(&vk, instance, physicalDevice, pfnGetInstanceProcAddr, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_vk_format(format) == VK_FORMAT_UNDEFINED)
        return SLUICE_ERROR_UNSUPPORTED;
    struct slc_caps device;
    slc_caps_init(&device, &vk);
    SluiceVulkanFormatCapabilities capabilities = {.structSize = sizeof capabilities};
    slc_format_caps_init(&capabilities, &vk, format);
    capabilities.sparse = capabilities.sparse && device.public.sparse;
    slc_struct_write(SLC_STRUCT(SluiceVulkanFormatCapabilities), pCapabilities, &capabilities);
    return SLUICE_SUCCESS;
}
