#include "vulkan/page_views.h"

#include "base/alloc.h"

SluiceResult slc_create_array_view(const struct slc_vk *vk, VkImage image, VkFormat format,
                                   VkImageView *view)
{
    VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
        .format = format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS}};
    SluiceResult result =
        slc_vk_result(vk, vk->CreateImageView(vk->device, &info, NULL, view), "vkCreateImageView");
    if (result != SLUICE_SUCCESS)
        *view = VK_NULL_HANDLE;
    slc_vk_name(vk, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)*view, "pages");
    return result;
}

static SluiceResult create_sampler(struct slc_page_views *views, const struct slc_vk *vk)
{
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_LINEAR,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateSampler(vk->device, &info, NULL, &views->sampler), "vkCreateSampler");
    if (result != SLUICE_SUCCESS)
        views->sampler = VK_NULL_HANDLE;
    slc_vk_name(vk, VK_OBJECT_TYPE_SAMPLER, (uint64_t)views->sampler, "pages");
    return result;
}

SluiceResult slc_page_views_init(struct slc_page_views *views, const struct slc_vk *vk,
                                 const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                 uint32_t count)
{
    *views = (struct slc_page_views){.count = count, .generation = 1};
    views->memory.purpose = SLUICE_DEVICE_MEMORY_PURPOSE_TABLE; /* one texel, no tiles */
    views->views = slc_calloc(cb, count, sizeof *views->views);
    if (!views->views)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    const struct slc_image_use sampled = {0};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = 1,
                                  .height = 1,
                                  .mipLevelCount = 1,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .cube = true, /* for arrays of textures */
                                  .pName = "empty page"};
    SluiceResult result =
        slc_plain_image_create(&views->image, &views->memory, vk, caps, cb, &info, 0, 6, &sampled);
    if (result == SLUICE_SUCCESS)
        result =
            slc_create_array_view(vk, views->image.image, VK_FORMAT_R8G8B8A8_UNORM, &views->empty);
    if (result == SLUICE_SUCCESS)
        result = create_sampler(views, vk);
    for (uint32_t i = 0; i < count; i++)
        views->views[i] = views->empty;
    return result;
}

void slc_page_views_finish(struct slc_page_views *views, const struct slc_vk *vk,
                           const SluiceAllocationCallbacks *cb)
{
    if (views->sampler)
        vk->DestroySampler(vk->device, views->sampler, NULL);
    if (views->empty)
        vk->DestroyImageView(vk->device, views->empty, NULL);
    slc_plain_image_destroy(&views->image, &views->memory, vk, cb);
    slc_image_memory_finish(&views->memory, cb);
    slc_free(cb, views->views, views->count, sizeof *views->views);
    *views = (struct slc_page_views){0};
}

SluiceResult slc_page_views_copy(struct slc_page_views *copy, const struct slc_page_views *views,
                                 const SluiceAllocationCallbacks *cb)
{
    *copy = (struct slc_page_views){
        .count = views->count, .generation = 1, .sampler = views->sampler, .empty = views->empty};
    copy->views = slc_alloc(cb, copy->count, sizeof *copy->views);
    if (!copy->views)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < copy->count; i++)
        copy->views[i] = copy->empty;
    return SLUICE_SUCCESS;
}

void slc_page_views_finish_copy(struct slc_page_views *copy, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, copy->views, copy->count, sizeof *copy->views);
    *copy = (struct slc_page_views){0};
}

void slc_page_views_set(struct slc_page_views *views, uint32_t index, VkImageView view)
{
    VkImageView now = view ? view : views->empty;
    views->generation += views->views[index] != now;
    views->views[index] = now;
}

bool slc_page_views_has(const struct slc_page_views *views, uint32_t index)
{
    return index < views->count && views->views[index] != views->empty;
}

void slc_record_general_layout(const struct slc_vk *vk, VkCommandBuffer commands, VkImage image)
{
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = VK_IMAGE_LAYOUT_GENERAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS}};
    vk->CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                           VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
}

void slc_page_views_record(const struct slc_page_views *views, const struct slc_vk *vk,
                           VkCommandBuffer commands)
{
    /* Several front ends may record this before the first one has run. */
    VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                              .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                              .dstAccessMask = VK_ACCESS_MEMORY_WRITE_BIT};
    vk->CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                           VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &memory, 0, NULL, 0, NULL);
    slc_record_general_layout(vk, commands, views->image.image);
}
