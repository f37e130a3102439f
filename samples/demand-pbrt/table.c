#include "table.h"

#include <string.h>

#include "../common/one_time.h"

#define LEAST_CAPACITY 64u

/* Bytes from which on the device copies, because the host reads device memory slowly. */
#define COPIED_BY_DEVICE ((VkDeviceSize)64 << 10)

struct growth {
    VkBuffer from, to;
    VkDeviceSize size;
};

static void record_growth(void *user_data, VkCommandBuffer commands)
{
    const struct growth *growth = user_data;
    const VkBufferCopy all = {.size = growth->size};
    vkCmdCopyBuffer(commands, growth->from, growth->to, 1, &all);
    gpu_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_HOST_READ_BIT |
                    VK_ACCESS_HOST_WRITE_BIT);
}

/** Copies the contents to a larger buffer and clears its rest. */
static bool take_over(const struct gpu *gpu, const struct table *table,
                      const struct gpu_buffer *larger)
{
    struct growth growth = {table->buffer.buffer, larger->buffer,
                            (VkDeviceSize)table->count * table->element};
    memset((char *)larger->mapped + growth.size, 0, larger->size - growth.size);
    if (growth.size >= COPIED_BY_DEVICE)
        return one_time_run(gpu, record_growth, &growth);
    if (growth.size > 0)
        memcpy(larger->mapped, table->buffer.mapped, growth.size);
    return true;
}

bool table_grow(const struct gpu *gpu, struct table *table, uint32_t count)
{
    if (count <= table->capacity && table->capacity > 0) {
        if (count > table->count)
            table->count = count;
        return true;
    }
    uint32_t capacity = table->capacity ? table->capacity : LEAST_CAPACITY;
    while (capacity < count)
        capacity *= 2;
    struct gpu_buffer buffer;
    if (!gpu_create_buffer(gpu, (VkDeviceSize)capacity * table->element,
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           &buffer))
        return false;
    if (!take_over(gpu, table, &buffer)) {
        gpu_destroy_buffer(gpu, &buffer);
        return false;
    }
    gpu_destroy_buffer(gpu, &table->buffer);
    table->buffer = buffer;
    table->capacity = capacity;
    table->count = count > table->count ? count : table->count;
    table->generation++;
    return true;
}

void table_finish(const struct gpu *gpu, struct table *table)
{
    gpu_destroy_buffer(gpu, &table->buffer);
    *table = (struct table){0};
}
