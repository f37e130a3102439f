#include "vulkan/device_heap.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "vulkan/sparse_layout.h"

static SluiceResult grow(struct slc_device_heaps *heaps, const SluiceAllocationCallbacks *cb)
{
    uint32_t capacity = slc_max_u32(16, 2 * heaps->capacity);
    struct slc_memory *memory = slc_calloc(cb, capacity, sizeof *memory);
    if (!memory)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < heaps->capacity; i++)
        memory[i] = heaps->memory[i];
    slc_free(cb, heaps->memory, heaps->capacity, sizeof *memory);
    heaps->memory = memory;
    heaps->capacity = capacity;
    return SLUICE_SUCCESS;
}

SluiceResult slc_device_heaps_allocate(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                                       const SluiceAllocationCallbacks *cb, uint64_t size,
                                       uint32_t memory_type, uint32_t *heap_id)
{
    uint32_t id = 0;
    while (id < heaps->capacity && heaps->memory[id].memory)
        id++;
    if (id == heaps->capacity) {
        SluiceResult result = grow(heaps, cb);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    const struct slc_memory_request request = {.size = size,
                                               .alignment = SLC_TILE_SIZE,
                                               .type = memory_type,
                                               .purpose = SLUICE_DEVICE_MEMORY_PURPOSE_HEAP,
                                               .name = "heap of tiles"};
    if (slc_memory_allocate(vk, &request, &heaps->memory[id]) != VK_SUCCESS)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    heaps->total_size += size;
    *heap_id = id;
    return SLUICE_SUCCESS;
}

void slc_device_heaps_release(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                              uint32_t heap_id)
{
    heaps->total_size -= heaps->memory[heap_id].size;
    slc_memory_free(vk, &heaps->memory[heap_id]);
}

void slc_device_heaps_finish(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                             const SluiceAllocationCallbacks *cb)
{
    for (uint32_t id = 0; id < heaps->capacity; id++)
        if (heaps->memory[id].memory)
            slc_device_heaps_release(heaps, vk, id);
    slc_free(cb, heaps->memory, heaps->capacity, sizeof *heaps->memory);
    *heaps = (struct slc_device_heaps){0};
}
