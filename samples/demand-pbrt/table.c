#include "table.h"

#include <string.h>

#define LEAST_CAPACITY 64u

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
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &buffer))
        return false;
    memset(buffer.mapped, 0, (size_t)capacity * table->element);
    if (table->count > 0)
        memcpy(buffer.mapped, table->buffer.mapped, (size_t)table->count * table->element);
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
