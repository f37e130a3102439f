#include "vulkan/texture_views.h"

#include "image/info.h"
#include "vulkan/format.h"

static SluiceResult create(const struct slc_vk *vk, VkImage image, const SluiceImageInfo *info,
                           VkImageViewType type, uint32_t layer, uint32_t layer_count,
                           VkImageView *view)
{
    VkImageViewCreateInfo create_info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                         .image = image,
                                         .viewType = type,
                                         .format = slc_vk_format(info->format),
                                         .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0,
                                                              VK_REMAINING_MIP_LEVELS, layer,
                                                              layer_count}};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateImageView(vk->device, &create_info, NULL, view), "vkCreateImageView");
    if (result == SLUICE_SUCCESS)
        slc_vk_name(vk, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)*view, "texture");
    else
        *view = VK_NULL_HANDLE;
    return result;
}

SluiceResult slc_texture_views_init(struct slc_texture_views *views, const struct slc_vk *vk,
                                    VkImage image, const SluiceImageInfo *info, uint32_t layer,
                                    bool cube_arrays)
{
    uint32_t count = info->arrayLayerCount;
    *views = (struct slc_texture_views){0};
    SluiceResult result = create(vk, image, info, VK_IMAGE_VIEW_TYPE_2D, layer, 1, &views->layer);
    if (result == SLUICE_SUCCESS && layer == 0 && count > 1)
        result = create(vk, image, info, VK_IMAGE_VIEW_TYPE_2D_ARRAY, 0, count, &views->array);
    if (!info->cube)
        return result;
    if (result == SLUICE_SUCCESS && layer % SLC_CUBE_FACES == 0)
        result =
            create(vk, image, info, VK_IMAGE_VIEW_TYPE_CUBE, layer, SLC_CUBE_FACES, &views->cube);
    if (result == SLUICE_SUCCESS && layer == 0 && count > SLC_CUBE_FACES && cube_arrays)
        result =
            create(vk, image, info, VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, 0, count, &views->cube_array);
    return result;
}

void slc_texture_views_finish(struct slc_texture_views *views, const struct slc_vk *vk)
{
    const VkImageView all[] = {views->layer, views->array, views->cube, views->cube_array};
    for (uint32_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (all[i])
            vk->DestroyImageView(vk->device, all[i], NULL);
    *views = (struct slc_texture_views){0};
}
