#include "vulkan/tile_producer.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/struct_size.h"
#include "vulkan/producer_calls.h"

SluiceResult slc_tile_producer_read(struct slc_tile_producer *producer, SluiceImageInfo *image,
                                    const SluiceTileProducer *given, const SluiceLogCallback *log)
{
    SluiceTileProducer info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceTileProducer), &info, given, log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info.pfnRecordTiles || !info.pImage)
        return SLUICE_ERROR_NULL_POINTER;
    result = slc_struct_read(SLC_STRUCT(SluiceImageInfo), image, info.pImage, log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (image->mipLevelCount == 0)
        image->mipLevelCount = slc_mip_count(slc_max_u32(image->width, image->height));
    *producer = (struct slc_tile_producer){
        .user = info.pUserData,
        .pfn = info.pfnRecordTiles,
        .timeout_frames = info.timeoutFrames ? info.timeoutFrames : SLC_PRODUCER_TIMEOUT};
    return SLUICE_SUCCESS;
}

static uint32_t level_count(const struct slc_residency_image *image)
{
    return image->desc.mipLevelCount - image->first_level;
}

SluiceResult slc_level_views_init(VkImageView **views, const struct slc_vk *vk,
                                  const SluiceAllocationCallbacks *cb,
                                  const struct slc_residency_image *image, VkFormat format,
                                  uint32_t layer_count)
{
    *views = NULL;
    if (!image->storage)
        return SLUICE_SUCCESS;
    *views = slc_calloc(cb, level_count(image), sizeof **views);
    if (!*views)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < level_count(image) && result == SLUICE_SUCCESS; i++) {
        VkImageViewCreateInfo info = {
            .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
            .image = image->image,
            .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
            .format = format,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, i, 1, 0, layer_count}};
        result = slc_vk_result(vk, vk->CreateImageView(vk->device, &info, NULL, &(*views)[i]),
                               "vkCreateImageView");
        if (result != SLUICE_SUCCESS)
            (*views)[i] = VK_NULL_HANDLE;
        slc_vk_name(vk, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)(*views)[i], "level");
    }
    return result;
}

void slc_level_views_finish(VkImageView **views, const struct slc_vk *vk,
                            const SluiceAllocationCallbacks *cb,
                            const struct slc_residency_image *image)
{
    if (!*views)
        return;
    for (uint32_t i = 0; i < level_count(image); i++)
        if ((*views)[i])
            vk->DestroyImageView(vk->device, (*views)[i], NULL);
    slc_free(cb, *views, level_count(image), sizeof **views);
    *views = NULL;
}
