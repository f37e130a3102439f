#include "copy_floor.h"

#include "../../tools/common/clock.h"
#include "../manager/figures.h"

#include <math.h>
#include <string.h>

#define TILE_BYTES 65536u
#define TILE_SIZE 128u /* texels of RGBA8 */
#define BATCH 256u     /* tiles per command */

struct copies {
    const struct gpu *gpu;
    struct gpu_buffer staging; ///< BATCH tiles
    struct gpu_image image;
    uint32_t columns, rows; ///< tiles per row; rows of tiles
    VkCommandBuffer commands;
};

static bool create_copies(struct copies *c, const struct gpu *gpu)
{
    uint32_t size = options.quick ? 2048 : 8192;
    *c = (struct copies){.gpu = gpu, .columns = size / TILE_SIZE, .rows = size / TILE_SIZE};
    VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                        .commandPool = gpu->command_pool,
                                        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                        .commandBufferCount = 1};
    return gpu_create_buffer(gpu, (VkDeviceSize)BATCH * TILE_BYTES,
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT, &c->staging) &&
           gpu_create_image(gpu, VK_FORMAT_R8G8B8A8_UNORM, size, size, VK_SAMPLE_COUNT_1_BIT,
                            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                            VK_IMAGE_ASPECT_COLOR_BIT, &c->image) &&
           gpu_check(vkAllocateCommandBuffers(gpu->device, &info, &c->commands),
                     "vkAllocateCommandBuffers");
}

static void destroy_copies(struct copies *c)
{
    const struct gpu *gpu = c->gpu;
    if (c->commands)
        vkFreeCommandBuffers(gpu->device, gpu->command_pool, 1, &c->commands);
    gpu_destroy_image(gpu, &c->image);
    gpu_destroy_buffer(gpu, &c->staging);
}

static void record_copies(const struct copies *c, uint32_t tile_count)
{
    VkImageMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                    .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                    .newLayout = VK_IMAGE_LAYOUT_GENERAL,
                                    .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                    .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                    .image = c->image.image,
                                    .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(c->commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
    for (uint32_t done = 0; done < tile_count; done += BATCH) {
        VkBufferImageCopy copies[BATCH];
        uint32_t count = tile_count - done < BATCH ? tile_count - done : BATCH;
        if (done % (c->columns * c->rows) == 0 && done) { /* fills the image again */
            VkMemoryBarrier again = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT};
            vkCmdPipelineBarrier(c->commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                 VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &again, 0, NULL, 0, NULL);
        }
        for (uint32_t i = 0; i < count; i++) {
            uint32_t tile = (done + i) % (c->columns * c->rows);
            copies[i] =
                (VkBufferImageCopy){.bufferOffset = (VkDeviceSize)i * TILE_BYTES,
                                    .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageOffset = {(int32_t)(tile % c->columns * TILE_SIZE),
                                                    (int32_t)(tile / c->columns * TILE_SIZE), 0},
                                    .imageExtent = {TILE_SIZE, TILE_SIZE, 1}};
        }
        vkCmdCopyBufferToImage(c->commands, c->staging.buffer, c->image.image,
                               VK_IMAGE_LAYOUT_GENERAL, count, copies);
    }
}

static bool run_copies(const struct copies *c, uint32_t tile_count, double *seconds)
{
    const struct gpu *gpu = c->gpu;
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                           .commandBufferCount = 1,
                           .pCommandBuffers = &c->commands};
    double start = clock_seconds();
    if (!gpu_check(vkBeginCommandBuffer(c->commands, &begin), "vkBeginCommandBuffer"))
        return false;
    record_copies(c, tile_count);
    if (!gpu_check(vkEndCommandBuffer(c->commands), "vkEndCommandBuffer") ||
        !gpu_check(vkQueueSubmit(gpu->queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit") ||
        !gpu_check(vkQueueWaitIdle(gpu->queue), "vkQueueWaitIdle"))
        return false;
    *seconds = clock_seconds() - start;
    return true;
}

/* Measures several buffers and returns the best: a device's speed depends on the location of host
 * memory. */
bool measure_copy_floor(const struct gpu *gpu, uint32_t tile_count, double *rate)
{
    bool done = true;
    double best = INFINITY;
    for (uint32_t i = 0; done && i < 15; i++) {
        struct copies c;
        double seconds = INFINITY;
        done = create_copies(&c, gpu);
        if (done)
            memset(c.staging.mapped, 0x5a, (size_t)c.staging.size);
        done = done && run_copies(&c, tile_count, &seconds) && run_copies(&c, tile_count, &seconds);
        best = seconds < best ? seconds : best;
        destroy_copies(&c);
    }
    *rate = tile_count / best;
    return done;
}
