#include "ui_texels.h"

bool ui_texels_fit(const struct gpu *gpu, uint32_t width, uint32_t height, struct ui_texels *t)
{
    if (t->gpu && t->width == width && t->height == height)
        return true;
    if (t->gpu)
        vkQueueWaitIdle(gpu->queue);
    ui_texels_destroy(t);
    *t = (struct ui_texels){.gpu = gpu, .width = width, .height = height};
    if (gpu_create_texture(gpu, VK_FORMAT_R8G8B8A8_UNORM, width, height, 1, &t->image) &&
        gpu_create_buffer(gpu, (VkDeviceSize)width * height * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                          &t->staging))
        return true;
    ui_texels_destroy(t);
    return false;
}

void ui_texels_destroy(struct ui_texels *t)
{
    if (!t->gpu)
        return;
    gpu_destroy_image(t->gpu, &t->image);
    gpu_destroy_buffer(t->gpu, &t->staging);
    *t = (struct ui_texels){0};
}

void ui_texels_record_layout(VkCommandBuffer commands, VkImage image, bool before)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = before ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = before ? VK_ACCESS_TRANSFER_WRITE_BIT : VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = before ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .newLayout = before ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL
                            : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(
        commands, before ? VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT,
        before ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, NULL,
        0, NULL, 1, &barrier);
}

void ui_texels_record(struct ui_texels *t, VkCommandBuffer commands)
{
    if (!t->changed)
        return;
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {t->width, t->height, 1}};
    ui_texels_record_layout(commands, t->image.image, true);
    vkCmdCopyBufferToImage(commands, t->staging.buffer, t->image.image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    ui_texels_record_layout(commands, t->image.image, false);
    t->changed = false;
    t->filled = true;
}
