#include "vulkan/memory.h"

#include <assert.h>

static uint64_t *counter(const struct slc_vk *vk, enum slc_memory_kind kind)
{
    return kind == SLC_MEMORY_HOST ? &vk->memory_use->host : &vk->memory_use->device;
}

VkResult slc_memory_allocate(const struct slc_vk *vk, uint64_t size, uint32_t type,
                             enum slc_memory_kind kind, VkDeviceMemory *memory)
{
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                 .allocationSize = size,
                                 .memoryTypeIndex = type};
    VkResult result = vk->AllocateMemory(vk->device, &info, NULL, memory);
    if (result != VK_SUCCESS)
        *memory = VK_NULL_HANDLE;
    else if (vk->memory_use)
        *counter(vk, kind) += size;
    return result;
}

void slc_memory_free(const struct slc_vk *vk, VkDeviceMemory memory, uint64_t size,
                     enum slc_memory_kind kind)
{
    if (!memory)
        return;
    vk->FreeMemory(vk->device, memory, NULL);
    if (!vk->memory_use)
        return;
    assert(*counter(vk, kind) >= size);
    *counter(vk, kind) -= size;
}

void slc_memory_move(const struct slc_vk *from, const struct slc_vk *to, uint64_t size,
                     enum slc_memory_kind kind)
{
    if (from->memory_use)
        *counter(from, kind) -= size;
    if (to->memory_use)
        *counter(to, kind) += size;
}
