#include "vulkan/plain_image.h"

#include "base/checked.h"
#include "base/log.h"
#include "vulkan/format.h"
#include "vulkan/format_caps.h"

static uint64_t texel_bytes(const SluiceImageInfo *info, uint32_t first_level)
{
    uint64_t bytes = 0;
    for (uint32_t level = first_level; level < info->mipLevelCount; level++)
        bytes += sluiceGetFormatRegionSize(info->format, slc_mip_size(info->width, level),
                                           slc_mip_size(info->height, level));
    return bytes;
}

/* Returns NULL, or the reason why the device does not support the image. */
static const char *check_format(const struct slc_vk *vk, const VkImageCreateInfo *create,
                                uint64_t size)
{
    VkImageFormatProperties limits;
    if (create->format == VK_FORMAT_UNDEFINED)
        return "has no Vulkan format";
    if (vk->GetPhysicalDeviceImageFormatProperties(vk->physical_device, create->format,
                                                   create->imageType, create->tiling, create->usage,
                                                   create->flags, &limits) != VK_SUCCESS)
        return "is not available as a sampled image";
    if (create->extent.width > limits.maxExtent.width ||
        create->extent.height > limits.maxExtent.height ||
        create->mipLevels > limits.maxMipLevels || create->arrayLayers > limits.maxArrayLayers ||
        size * create->arrayLayers > limits.maxResourceSize)
        return "is larger than the device allows";
    return NULL;
}

SluiceResult slc_plain_image_create(struct slc_plain_image *image, struct slc_image_memory *memory,
                                    const struct slc_vk *vk, const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb,
                                    const SluiceImageInfo *info, uint32_t first_level,
                                    uint32_t layer_count, const struct slc_image_use *use)
{
    *image = (struct slc_plain_image){0};
    VkImageCreateInfo create = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                .flags = slc_image_flags(info),
                                .imageType = VK_IMAGE_TYPE_2D,
                                .format = slc_vk_format(info->format),
                                .extent = {slc_mip_size(info->width, first_level),
                                           slc_mip_size(info->height, first_level), 1},
                                .mipLevels = info->mipLevelCount - first_level,
                                .arrayLayers = layer_count,
                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                .tiling = VK_IMAGE_TILING_OPTIMAL,
                                .usage =
                                    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
    if (memory->purpose == SLUICE_DEVICE_MEMORY_PURPOSE_PAGES)
        create.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT; /* for moves of tiles between images */
    struct slc_image_formats formats;
    SLC_VK_SHARE(vk, &create);
    slc_image_use_apply(use, &create, &formats);
    const char *trouble = check_format(vk, &create, texel_bytes(info, first_level));
    if (trouble) {
        slc_log(&vk->log, SLUICE_LOG_ERROR, "%s: %ux%u %s %s", info->pName ? info->pName : "image",
                info->width, info->height, sluiceGetFormatName(info->format), trouble);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    image->storage = use->produced && slc_image_may_store(vk, &create);
    if (image->storage)
        create.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    SluiceResult result = slc_vk_result(
        vk, vk->CreateImage(vk->device, &create, NULL, &image->image), "vkCreateImage");
    if (result != SLUICE_SUCCESS) {
        image->image = VK_NULL_HANDLE;
        return result;
    }
    slc_vk_name(vk, VK_OBJECT_TYPE_IMAGE, (uint64_t)image->image,
                info->pName ? info->pName : "texture");
    result = slc_image_memory_bind(memory, vk, caps, cb, image->image, &image->place);
    if (result != SLUICE_SUCCESS)
        slc_plain_image_destroy(image, memory, vk, cb);
    return result;
}

void slc_plain_image_destroy(struct slc_plain_image *image, struct slc_image_memory *memory,
                             const struct slc_vk *vk, const SluiceAllocationCallbacks *cb)
{
    if (image->image)
        vk->DestroyImage(vk->device, image->image, NULL);
    slc_image_memory_release(memory, vk, cb, &image->place);
    *image = (struct slc_plain_image){0};
}
