#include "vulkan/device_heap.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "vulkan/memory.h"

static SluiceResult grow(struct slc_device_heaps *heaps, const SluiceAllocationCallbacks *cb)
{
    uint32_t capacity = slc_max_u32(16, 2 * heaps->capacity);
    VkDeviceMemory *memory = slc_calloc(cb, capacity, sizeof *memory);
    uint64_t *sizes = slc_calloc(cb, capacity, sizeof *sizes);
    if (!memory || !sizes) {
        slc_free(cb, memory, capacity, sizeof *memory);
        slc_free(cb, sizes, capacity, sizeof *sizes);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    for (uint32_t i = 0; i < heaps->capacity; i++) {
        memory[i] = heaps->memory[i];
        sizes[i] = heaps->sizes[i];
    }
    slc_free(cb, heaps->memory, heaps->capacity, sizeof *memory);
    slc_free(cb, heaps->sizes, heaps->capacity, sizeof *sizes);
    heaps->memory = memory;
    heaps->sizes = sizes;
    heaps->capacity = capacity;
    return SLUICE_SUCCESS;
}

SluiceResult slc_device_heaps_allocate(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                                       const SluiceAllocationCallbacks *cb, uint64_t size,
                                       uint32_t memory_type, uint32_t *heap_id)
{
    uint32_t id = 0;
    while (id < heaps->capacity && heaps->memory[id])
        id++;
    if (id == heaps->capacity) {
        SluiceResult result = grow(heaps, cb);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    if (slc_memory_allocate(vk, size, memory_type, SLC_MEMORY_DEVICE, &heaps->memory[id]) !=
        VK_SUCCESS)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    heaps->sizes[id] = size;
    heaps->total_size += size;
    *heap_id = id;
    return SLUICE_SUCCESS;
}

void slc_device_heaps_release(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                              uint32_t heap_id)
{
    slc_memory_free(vk, heaps->memory[heap_id], heaps->sizes[heap_id], SLC_MEMORY_DEVICE);
    heaps->memory[heap_id] = VK_NULL_HANDLE;
    heaps->total_size -= heaps->sizes[heap_id];
}

void slc_device_heaps_finish(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                             const SluiceAllocationCallbacks *cb)
{
    for (uint32_t id = 0; id < heaps->capacity; id++)
        if (heaps->memory[id])
            slc_device_heaps_release(heaps, vk, id);
    slc_free(cb, heaps->memory, heaps->capacity, sizeof *heaps->memory);
    slc_free(cb, heaps->sizes, heaps->capacity, sizeof *heaps->sizes);
    *heaps = (struct slc_device_heaps){0};
}
