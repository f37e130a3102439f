/* Baseline of demand loading: ordinary images that hold all texels. */
#include "rig.h"

#include <string.h>

static uint32_t level_count(uint32_t size)
{
    uint32_t count = 1;
    while (size >> count)
        count++;
    return count;
}

static void to_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to)
{
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0, 1}};
    VkPipelineStageFlags stages =
        VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, stages, 0, 0, NULL, 0, NULL, 1,
                         &barrier);
}

/* Fills an image with the source's texels, in strips of the buffer's size. */
static void record_fill(const struct rig *rig, VkCommandBuffer commands, VkImage image,
                        const struct gpu_buffer *texels)
{
    uint32_t size = rig->bench->texture_size;
    to_layout(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    for (uint32_t level = 0; level < level_count(size); level++) {
        uint32_t edge = size >> level, rows = (uint32_t)(texels->size / 4 / edge);
        for (uint32_t y = 0; y < edge; y += rows) {
            uint32_t height = rows < edge - y ? rows : edge - y;
            VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1},
                                      .imageOffset = {0, (int32_t)y, 0},
                                      .imageExtent = {edge, height, 1}};
            vkCmdCopyBufferToImage(commands, texels->buffer, image, VK_IMAGE_LAYOUT_GENERAL, 1,
                                   &copy);
        }
    }
    to_layout(commands, image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
}

static bool fill(struct rig *rig, const struct gpu_buffer *texels)
{
    const struct gpu *gpu = &rig->bench->gpu;
    VkCommandBuffer commands = rig->slots[0].commands;
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (!gpu_check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer"))
        return false;
    for (uint32_t i = 0; i < rig->texture_count; i++)
        record_fill(rig, commands, rig->plain[i].image, texels);
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                           .commandBufferCount = 1,
                           .pCommandBuffers = &commands};
    return gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") &&
           gpu_check(vkQueueSubmit(gpu->queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit") &&
           gpu_check(vkQueueWaitIdle(gpu->queue), "vkQueueWaitIdle");
}

bool rig_create_plain(struct rig *rig)
{
    const struct gpu *gpu = &rig->bench->gpu;
    uint32_t size = rig->bench->texture_size;
    struct gpu_buffer texels = {0};
    bool done = gpu_create_buffer(gpu, 1u << 24, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, &texels);
    if (done) {
        SluiceImageRegion tile = {.width = 2048, .height = 2048};
        done = check(rig->sources[0].base.pInterface->pfnReadRegion(
                         &rig->sources[0].base, &tile, texels.mapped, (size_t)4 * 2048),
                     "pfnReadRegion");
    }
    for (uint32_t i = 0; done && i < rig->texture_count; i++)
        done = gpu_create_texture(gpu, VK_FORMAT_R8G8B8A8_UNORM, size, size, level_count(size),
                                  &rig->plain[i]);
    done = done && fill(rig, &texels);
    gpu_destroy_buffer(gpu, &texels);
    return done;
}

void rig_destroy_plain(struct rig *rig)
{
    for (uint32_t i = 0; i < DEMAND_BENCH_TEXTURES; i++)
        gpu_destroy_image(&rig->bench->gpu, &rig->plain[i]);
}
