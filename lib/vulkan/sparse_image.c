#include "vulkan/sparse_image.h"

#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "vulkan/format.h"
#include "vulkan/format_caps.h"
#include "vulkan/memory.h"

#define MAX_ASPECTS 4u

static VkImageCreateInfo image_create_info(VkFormat format, uint32_t width, uint32_t height,
                                           uint32_t level_count, uint32_t layer_count)
{
    return (VkImageCreateInfo){.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .flags = SLC_IMAGE_SPARSE_FLAGS,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {width, height, 1},
                               .mipLevels = level_count,
                               .arrayLayers = layer_count,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = SLC_IMAGE_USAGE,
                               .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
                               .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
}

SluiceResult slc_sparse_memory_type(const struct slc_vk *vk, const struct slc_caps *caps,
                                    uint32_t *memory_type)
{
    VkImageCreateInfo info = image_create_info(VK_FORMAT_R8G8B8A8_UNORM, 1024, 1024, 1, 1);
    VkImage image;
    SLC_VK_SHARE(vk, &info);
    SluiceResult result =
        slc_vk_result(vk, vk->CreateImage(vk->device, &info, NULL, &image), "vkCreateImage");
    if (result != SLUICE_SUCCESS)
        return result;
    VkMemoryRequirements memory;
    vk->GetImageMemoryRequirements(vk->device, image, &memory);
    vk->DestroyImage(vk->device, image, NULL);
    /* DEVICE_LOCAL is requested explicitly: the first allowed type may be system memory. */
    *memory_type = slc_find_memory_type(&caps->memory, memory.memoryTypeBits,
                                        VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0);
    if (*memory_type != UINT32_MAX)
        return SLUICE_SUCCESS;
    slc_log(&vk->log, SLUICE_LOG_ERROR, "%s has no device-local memory for sparse images",
            caps->public.deviceName);
    return SLUICE_ERROR_UNSUPPORTED;
}

static uint32_t layer_count(const SluiceImageInfo *info)
{
    return slc_max_u32(1, info->arrayLayerCount);
}

/* Returns a lower bound of the image's size. Images beyond the driver's limit must not be created.
 */
static uint64_t texel_bytes(const SluiceImageInfo *info)
{
    uint64_t size = 0;
    for (uint32_t level = 0; level < info->mipLevelCount; level++)
        size += sluiceGetFormatRegionSize(info->format, slc_mip_size(info->width, level),
                                          slc_mip_size(info->height, level));
    return size * layer_count(info);
}

static const char *check_format(const struct slc_vk *vk, const struct slc_caps *caps,
                                const SluiceImageInfo *image)
{
    SluiceVulkanFormatCapabilities format = {.structSize = sizeof format};
    if (slc_vk_format(image->format) == VK_FORMAT_UNDEFINED)
        return "has no Vulkan format";
    slc_format_caps_init(&format, vk, image->format);
    if (!format.tileWidth)
        return "is not available as a sparse image";
    if (!format.sparse)
        return "has tiles that are not pages of 64 KiB";
    if (image->width > format.maxWidth || image->height > format.maxHeight ||
        image->mipLevelCount > format.maxMipLevelCount ||
        layer_count(image) > format.maxArrayLayerCount)
        return "is larger than the device allows";
    if (image->cube && !caps->public.sparseCubes)
        return "is a cube map, which the device does not sample correctly if it is sparse";
    if (image->cube && image->width > slc_max_sparse_cube_width(vk, image->format))
        return "is larger than sparse cube maps of the device are";
    if (texel_bytes(image) > format.maxImageSize ||
        texel_bytes(image) > caps->public.sparseAddressSpaceSize)
        return "is larger than the sparse address space";
    return NULL;
}

/* Reads the layout of the image from the driver. Returns NULL, or why the layout is refused. */
static const char *read_layout(struct slc_sparse_image *image, const struct slc_vk *vk,
                               const struct slc_caps *caps, uint32_t memory_type,
                               const SluiceImageInfo *info)
{
    VkMemoryRequirements memory;
    vk->GetImageMemoryRequirements(vk->device, image->image, &memory);
    VkSparseImageMemoryRequirements aspects[MAX_ASPECTS];
    uint32_t count = MAX_ASPECTS;
    vk->GetImageSparseMemoryRequirements(vk->device, image->image, &count, aspects);
    const VkSparseImageMemoryRequirements *color = NULL, *metadata = NULL;
    for (uint32_t i = 0; i < count; i++) {
        if (aspects[i].formatProperties.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT)
            color = &aspects[i];
        if (aspects[i].formatProperties.aspectMask & VK_IMAGE_ASPECT_METADATA_BIT)
            metadata = &aspects[i];
    }
    if (!color)
        return "has no sparse memory requirements";
    if (!(memory.memoryTypeBits >> memory_type & 1))
        return "cannot be bound to the memory of the heaps";
    if (memory.size > caps->public.sparseAddressSpaceSize)
        return "is larger than the sparse address space";
    if (slc_sparse_layers_share_tail(info, color))
        return "has one mip tail for all layers, and layers are loaded one by one: it is too small "
               "for an array on this device";
    if (slc_sparse_layout_init(&image->layout, info, &memory, color, metadata,
                               caps->public.sparseAddressSpaceSize) != SLUICE_SUCCESS)
        return "has tiles that are not pages of 64 KiB";
    return NULL;
}

static SluiceResult allocate_metadata(struct slc_sparse_image *image, const struct slc_vk *vk,
                                      uint32_t memory_type, uint32_t count)
{
    VkMemoryRequirements memory;
    vk->GetImageMemoryRequirements(vk->device, image->image, &memory);
    const struct slc_memory_request request = {.size = image->layout.metadata_size * count,
                                               .alignment = memory.alignment,
                                               .type = memory_type,
                                               .purpose = SLUICE_DEVICE_MEMORY_PURPOSE_IMAGE,
                                               .name = "image metadata"};
    return slc_vk_result(vk, slc_memory_allocate(vk, &request, &image->metadata),
                         "vkAllocateMemory for image metadata");
}

/* Fills in the other layers. Layers share image and metadata, and each binds its own part. */
static void fill_layers(struct slc_sparse_image *images, uint32_t count)
{
    images[0].layer_count = count;
    for (uint32_t i = 1; i < count; i++) {
        images[i] = images[0];
        images[i].layer = i;
    }
}

SluiceResult slc_sparse_image_create(struct slc_sparse_image *image, const struct slc_vk *vk,
                                     const struct slc_caps *caps, uint32_t memory_type,
                                     const SluiceImageInfo *info, const struct slc_image_use *use,
                                     const char **refusal)
{
    *image = (struct slc_sparse_image){0};
    VkImageCreateInfo create =
        image_create_info(slc_vk_format(info->format), info->width, info->height,
                          info->mipLevelCount, layer_count(info));
    struct slc_image_formats formats;
    SLC_VK_SHARE(vk, &create);
    create.flags |= slc_image_flags(info);
    slc_image_use_apply(use, &create, &formats);
    const char *trouble = check_format(vk, caps, info);
    SluiceResult result = SLUICE_ERROR_UNSUPPORTED;
    if (!trouble && use->mutable_format && !slc_image_is_supported(vk, &create, 0))
        trouble = "is not available as a sparse image with mutableFormat";
    if (!trouble) {
        image->storage = use->produced && slc_image_may_store(vk, &create);
        if (image->storage)
            create.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
        result = slc_vk_result(vk, vk->CreateImage(vk->device, &create, NULL, &image->image),
                               "vkCreateImage");
        if (result != SLUICE_SUCCESS)
            return result;
        slc_vk_name(vk, VK_OBJECT_TYPE_IMAGE, (uint64_t)image->image,
                    info->pName ? info->pName : "texture");
        trouble = read_layout(image, vk, caps, memory_type, info);
    }
    if (trouble) {
        if (refusal)
            *refusal = trouble;
        else
            slc_log(&vk->log, SLUICE_LOG_ERROR, "%s: %ux%u %s %s",
                    info->pName ? info->pName : "image", info->width, info->height,
                    sluiceGetFormatName(info->format), trouble);
        slc_sparse_image_destroy(image, vk);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (image->layout.metadata_size)
        result = allocate_metadata(image, vk, memory_type, layer_count(info));
    if (result != SLUICE_SUCCESS)
        slc_sparse_image_destroy(image, vk);
    else
        fill_layers(image, layer_count(info));
    return result;
}

void slc_sparse_image_destroy(struct slc_sparse_image *images, const struct slc_vk *vk)
{
    vk->DestroyImage(vk->device, images->image, NULL);
    slc_memory_free(vk, &images->metadata);
    for (uint32_t i = images->layer_count; i-- > 1;)
        images[i] = (struct slc_sparse_image){0};
    *images = (struct slc_sparse_image){0};
}

static void describe(SluiceVulkanSparseImageLayout *out, const struct slc_vk *vk,
                     const struct slc_sparse_image *image)
{
    const struct slc_sparse_layout *layout = &image->layout;
    VkMemoryRequirements memory;
    vk->GetImageMemoryRequirements(vk->device, image->image, &memory);
    *out = (SluiceVulkanSparseImageLayout){
        .structSize = sizeof(SluiceVulkanSparseImageLayout),
        .mipLevelCount = layout->desc.mipLevelCount,
        .tileWidth = layout->desc.tileWidth,
        .tileHeight = layout->desc.tileHeight,
        .regularMipCount = layout->desc.regularMipCount,
        .packedTileCount = layout->desc.packedTileCount,
        .driverTail = layout->opaque_tail,
        .tailSize = layout->tail_size,
        .metadataSize = layout->metadata_size,
        .imageSize = memory.size,
        .alignment = memory.alignment,
        .memoryTypeBits = memory.memoryTypeBits,
    };
}

SluiceResult sluiceGetVulkanSparseImageLayout(VkInstance instance, VkPhysicalDevice physicalDevice,
                                              VkDevice device,
                                              PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr,
                                              const SluiceLogCallback *pLog,
                                              const SluiceImageInfo *pImage,
                                              SluiceVulkanSparseImageLayout *pLayout)
{
    if (!instance || !physicalDevice || !device || !pfnGetInstanceProcAddr || !pImage || !pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceVulkanSparseImageLayout), pLayout, pLog);
    if (checked != SLUICE_SUCCESS)
        return checked;
    if (pImage->width == 0 || pImage->height == 0)
        return slc_log_refusal(pLog, "width is %u and height is %u; both must be above 0",
                               pImage->width, pImage->height);
    struct slc_vk vk;
    struct slc_caps caps;
    struct slc_sparse_image image;
    uint32_t memory_type;
    const struct slc_image_use sampled = {0};
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceImageInfo), &info, pImage, pLog);
    if (result != SLUICE_SUCCESS)
        return result;
    info.mipLevelCount = slc_mip_count(slc_max_u32(info.width, info.height));
    info.arrayLayerCount = 1;
    result = slc_vk_init_instance(&vk, instance, physicalDevice, pfnGetInstanceProcAddr, pLog);
    if (result == SLUICE_SUCCESS)
        result = slc_vk_init_device(&vk, device);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_caps_init(&caps, &vk);
    if (!caps.public.sparse) {
        slc_log(pLog, SLUICE_LOG_ERROR, "%s has no sparse residency of 2D images",
                caps.public.deviceName);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    result = slc_sparse_memory_type(&vk, &caps, &memory_type);
    if (result == SLUICE_SUCCESS)
        result = slc_sparse_image_create(&image, &vk, &caps, memory_type, &info, &sampled, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceVulkanSparseImageLayout layout = {.structSize = sizeof layout};
    describe(&layout, &vk, &image);
    slc_struct_write(SLC_STRUCT(SluiceVulkanSparseImageLayout), pLayout, &layout);
    slc_sparse_image_destroy(&image, &vk);
    return SLUICE_SUCCESS;
}
