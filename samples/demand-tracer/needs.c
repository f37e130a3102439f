#include "needs.h"

#include "../common/one_time.h"
#include "tracer_shared.h"

static void record_clear(void *user_data, VkCommandBuffer commands)
{
    const struct needs *needs = user_data;
    vkCmdFillBuffer(commands, needs->pages.buffer, 0, VK_WHOLE_SIZE, 0);
}

bool needs_create(const struct gpu *gpu, bool on, struct needs *needs)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkDeviceSize size = on ? TRACER_PAGE_CAPACITY / 8 : sizeof(uint32_t);
    *needs = (struct needs){.on = on};
    return gpu_create_device_buffer(gpu, size, usage, &needs->pages) &&
           one_time_run(gpu, record_clear, needs);
}

void needs_destroy(const struct gpu *gpu, struct needs *needs)
{
    gpu_destroy_buffer(gpu, &needs->pages);
    *needs = (struct needs){0};
}

struct readback {
    const struct needs *needs;
    struct gpu_buffer buffer;
};

static void record_readback(void *user_data, VkCommandBuffer commands)
{
    const struct readback *readback = user_data;
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdCopyBuffer(commands, readback->needs->pages.buffer, readback->buffer.buffer, 1,
                    &(VkBufferCopy){0, 0, TRACER_PAGE_CAPACITY / 8});
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &barrier, 0, NULL, 0, NULL);
}

static uint64_t count_bits(const uint32_t *words, uint32_t count)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t bits = words[i]; bits; bits &= bits - 1)
            sum++;
    return sum;
}

bool needs_count(const struct gpu *gpu, const struct needs *needs, uint64_t *page_count)
{
    struct readback readback = {.needs = needs};
    bool done = gpu_create_buffer(gpu, TRACER_PAGE_CAPACITY / 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                  &readback.buffer) &&
                one_time_run(gpu, record_readback, &readback);
    if (done)
        *page_count = count_bits(readback.buffer.mapped, TRACER_PAGE_CAPACITY / 32);
    gpu_destroy_buffer(gpu, &readback.buffer);
    return done;
}
