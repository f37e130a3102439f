#include "floors.h"

#include "../../tools/common/clock.h"

#include <math.h>
#include <string.h>

#define TILE_BYTES 65536u
#define TILE_SIZE 128u /* texels of RGBA8 */
#define BATCH 256u     /* tiles in a command, and in a batch of bindings */
#define RUN 16u        /* tiles of a row that are bound as one */

struct copies {
    const struct bench *bench;
    struct gpu_buffer staging; ///< BATCH tiles
    struct gpu_image image;
    uint32_t columns, rows; ///< of tiles
    VkCommandBuffer commands;
};

static bool create_copies(struct copies *c, const struct bench *bench)
{
    uint32_t size = options.quick ? 2048 : 8192;
    *c = (struct copies){.bench = bench, .columns = size / TILE_SIZE, .rows = size / TILE_SIZE};
    const struct gpu *gpu = &bench->gpu;
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
    const struct gpu *gpu = &c->bench->gpu;
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
        if (done % (c->columns * c->rows) == 0 && done) { /* the image once more */
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
    const struct gpu *gpu = &c->bench->gpu;
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

/* The best of several buffers: how fast a device reads host memory depends on where that lies. */
static bool measure_copies(const struct bench *bench, uint32_t tile_count, double *rate)
{
    bool done = true;
    double best = INFINITY;
    for (uint32_t i = 0; done && i < 15; i++) {
        struct copies c;
        double seconds = INFINITY;
        done = create_copies(&c, bench);
        if (done)
            memset(c.staging.mapped, 0x5a, (size_t)c.staging.size);
        done = done && run_copies(&c, tile_count, &seconds) && run_copies(&c, tile_count, &seconds);
        best = seconds < best ? seconds : best;
        destroy_copies(&c);
    }
    *rate = tile_count / best;
    return done;
}

struct binds {
    const struct bench *bench;
    VkImage image;
    VkDeviceMemory memory;
    VkFence fence;
    uint32_t columns, tile_count; ///< of the image's level 0, that have memory
};

static bool create_binds(struct binds *b, const struct bench *bench, uint32_t tile_count)
{
    const struct gpu *gpu = &bench->gpu;
    const uint32_t size = 16384;
    *b = (struct binds){
        .bench = bench, .columns = size / TILE_SIZE, .tile_count = tile_count / BATCH * BATCH};
    VkImageCreateInfo image = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .flags = VK_IMAGE_CREATE_SPARSE_BINDING_BIT | VK_IMAGE_CREATE_SPARSE_RESIDENCY_BIT,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_R8G8B8A8_UNORM,
        .extent = {size, size, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    if (!gpu_check(vkCreateImage(gpu->device, &image, NULL, &b->image), "vkCreateImage"))
        return false;
    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(gpu->device, b->image, &requirements);
    VkMemoryAllocateInfo memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                   .allocationSize = (VkDeviceSize)b->tile_count * TILE_BYTES,
                                   .memoryTypeIndex =
                                       device_local_type(gpu, requirements.memoryTypeBits)};
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    return gpu_check(vkAllocateMemory(gpu->device, &memory, NULL, &b->memory),
                     "vkAllocateMemory") &&
           gpu_check(vkCreateFence(gpu->device, &fence, NULL, &b->fence), "vkCreateFence");
}

static void destroy_binds(struct binds *b)
{
    VkDevice device = b->bench->gpu.device;
    vkDestroyFence(device, b->fence, NULL);
    vkDestroyImage(device, b->image, NULL);
    vkFreeMemory(device, b->memory, NULL);
}

/* One batch for each BATCH tiles, in runs of `run` tiles, all submitted before the first is over.
 */
static bool run_binds(const struct binds *b, uint32_t run, double *seconds)
{
    const struct gpu *gpu = &b->bench->gpu;
    double start = clock_seconds();
    for (uint32_t first = 0; first < b->tile_count; first += BATCH) {
        VkSparseImageMemoryBind binds[BATCH];
        uint32_t count = 0;
        for (uint32_t i = first; i < first + BATCH; i += run)
            binds[count++] =
                (VkSparseImageMemoryBind){.subresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0},
                                          .offset = {(int32_t)(i % b->columns * TILE_SIZE),
                                                     (int32_t)(i / b->columns * TILE_SIZE), 0},
                                          .extent = {run * TILE_SIZE, TILE_SIZE, 1},
                                          .memory = b->memory,
                                          .memoryOffset = (VkDeviceSize)i * TILE_BYTES};
        VkSparseImageMemoryBindInfo image = {b->image, count, binds};
        VkBindSparseInfo info = {.sType = VK_STRUCTURE_TYPE_BIND_SPARSE_INFO,
                                 .imageBindCount = 1,
                                 .pImageBinds = &image};
        bool last = first + BATCH == b->tile_count;
        if (!gpu_check(
                vkQueueBindSparse(gpu->sparse_queue, 1, &info, last ? b->fence : VK_NULL_HANDLE),
                "vkQueueBindSparse"))
            return false;
    }
    if (!gpu_check(vkWaitForFences(gpu->device, 1, &b->fence, VK_TRUE, UINT64_MAX),
                   "vkWaitForFences") ||
        !gpu_check(vkResetFences(gpu->device, 1, &b->fence), "vkResetFences"))
        return false;
    *seconds = clock_seconds() - start;
    return true;
}

/* A new image each time: what was bound before would be unbound first. */
static bool measure_binds(const struct bench *bench, uint32_t tile_count, uint32_t run,
                          double *rate)
{
    struct binds b;
    double seconds = NAN;
    bool done = create_binds(&b, bench, tile_count) && run_binds(&b, run, &seconds);
    *rate = b.tile_count / seconds;
    destroy_binds(&b);
    return done;
}

bool measure_floors(const struct bench *bench, uint32_t tile_count, struct floors *floors)
{
    *floors = (struct floors){NAN, NAN, NAN};
    if (!measure_copies(bench, tile_count, &floors->copy))
        return false;
    return bench->mode != SLUICE_RESIDENCY_MODE_SPARSE || tile_count < BATCH ||
           (measure_binds(bench, tile_count, 1, &floors->bind) &&
            measure_binds(bench, tile_count, RUN, &floors->bind_runs));
}
