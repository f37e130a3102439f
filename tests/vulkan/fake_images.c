#include "vulkan/fake_functions.h"
#include "vulkan/fake_objects.h"

static VKAPI_ATTR VkResult VKAPI_CALL create_image(VkDevice device, const VkImageCreateInfo *info,
                                                   const VkAllocationCallbacks *cb, VkImage *image)
{
    FAKE_MAY_FAIL(device);
    (void)cb;
    struct fake_object *object = fake_make_shown(fake_of(device), 0);
    object->extent = info->extent;
    object->level_count = info->mipLevels;
    object->layer_count = info->arrayLayers;
    object->image_flags = info->flags;
    FAKE_SHARE(object, info);
    const VkImageFormatListCreateInfo *list = info->pNext;
    for (; list && object->format_count < list->viewFormatCount; object->format_count++)
        object->view_formats[object->format_count] = list->pViewFormats[object->format_count];
    *image = (VkImage)object;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_image(VkDevice device, VkImage image,
                                                const VkAllocationCallbacks *cb)
{
    (void)cb;
    struct fake_vulkan *fake = fake_of(device);
    if (image && fake->destroyed_count < FAKE_EVENTS)
        fake->destroyed_images[fake->destroyed_count++] = image;
    fake_drop(fake, image);
}

static VKAPI_ATTR void VKAPI_CALL image_requirements(VkDevice device, VkImage image,
                                                     VkMemoryRequirements *requirements)
{
    uint64_t layer_size = fake_of(device)->layer_size;
    uint64_t size = layer_size ? layer_size * FAKE_OBJECT(image)->layer_count : 1u << 24;
    *requirements = (VkMemoryRequirements){.size = size, .alignment = 65536, .memoryTypeBits = 1};
}

static VKAPI_ATTR void VKAPI_CALL sparse_requirements(VkDevice device, VkImage image,
                                                      uint32_t *count,
                                                      VkSparseImageMemoryRequirements *requirements)
{
    struct fake_vulkan *fake = fake_of(device);
    const struct fake_object *object = FAKE_OBJECT(image);
    uint32_t tail = 0;
    while (object->extent.width >> tail > FAKE_TILE || object->extent.height >> tail > FAKE_TILE)
        tail++;
    *count = fake->metadata_size ? 2 : 1;
    requirements[1] = (VkSparseImageMemoryRequirements){
        .formatProperties = {VK_IMAGE_ASPECT_METADATA_BIT, {0}, 0},
        .imageMipTailSize = fake->metadata_size,
        .imageMipTailOffset = 1ull << 31,
        .imageMipTailStride = FAKE_TAIL_STRIDE};
    requirements[0] = (VkSparseImageMemoryRequirements){
        .formatProperties = {VK_IMAGE_ASPECT_COLOR_BIT, {FAKE_TILE, FAKE_TILE, 1}, 0},
        .imageMipTailFirstLod = fake->tail_page_count ? tail : object->level_count,
        .imageMipTailSize = fake->tail_page_count * 65536ull,
        .imageMipTailOffset = 1ull << 30,
        .imageMipTailStride = FAKE_TAIL_STRIDE};
}

static VKAPI_ATTR VkResult VKAPI_CALL create_ImageView(VkDevice device,
                                                       const VkImageViewCreateInfo *info,
                                                       const VkAllocationCallbacks *cb,
                                                       VkImageView *view)
{
    (void)cb;
    FAKE_MAY_FAIL(device);
    struct fake_object *object = fake_make_shown(fake_of(device), 0);
    object->image = info->image;
    *view = (VkImageView)object;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_ImageView(VkDevice device, VkImageView view,
                                                    const VkAllocationCallbacks *cb)
{
    (void)cb;
    fake_drop(fake_of(device), view);
}

VkImage fake_vulkan_image_of(VkImageView view)
{
    return FAKE_OBJECT(view)->image;
}

const struct fake_function fake_image_functions[] = {
    FAKE_FUNCTION(CreateImage, create_image),
    FAKE_FUNCTION(CreateImageView, create_ImageView),
    FAKE_FUNCTION(DestroyImage, destroy_image),
    FAKE_FUNCTION(DestroyImageView, destroy_ImageView),
    FAKE_FUNCTION(GetImageMemoryRequirements, image_requirements),
    FAKE_FUNCTION(GetImageSparseMemoryRequirements, sparse_requirements),
    {NULL, NULL},
};
