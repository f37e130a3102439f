#include "floors.h"

#include "copy_floor.h"

#include "../../tools/common/clock.h"

#include <math.h>
#include <string.h>

#define TILE_BYTES 65536u
#define TILE_SIZE 128u /* texels of RGBA8 */
#define BATCH 256u     /* tiles per batch of bindings */
#define RUN 16u        /* tiles of a row that are bound as one */

struct binds {
    const struct bench *bench;
    VkImage image;
    VkDeviceMemory memory;
    VkFence fence;
    uint32_t columns, tile_count; ///< tiles of level 0 per row; tiles with memory
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

/* Submits a batch per BATCH tiles, in runs of `run` tiles, all before the first has completed. */
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

/* Uses a new image each time: otherwise earlier bindings would be replaced. */
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
    if (!measure_copy_floor(&bench->gpu, tile_count, &floors->copy))
        return false;
    return bench->mode != SLUICE_RESIDENCY_MODE_SPARSE || tile_count < BATCH ||
           (measure_binds(bench, tile_count, 1, &floors->bind) &&
            measure_binds(bench, tile_count, RUN, &floors->bind_runs));
}
