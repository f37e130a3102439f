#include "vulkan/device_heap.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "vulkan/sparse_layout.h"

#include <assert.h>

static SluiceResult grow(struct slc_device_heaps *heaps, const SluiceAllocationCallbacks *cb)
{
    uint32_t capacity = slc_max_u32(16, 2 * heaps->capacity);
    struct slc_device_heap *at = slc_calloc(cb, capacity, sizeof *at);
    if (!at)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < heaps->capacity; i++)
        at[i] = heaps->at[i];
    slc_free(cb, heaps->at, heaps->capacity, sizeof *at);
    heaps->at = at;
    heaps->capacity = capacity;
    return SLUICE_SUCCESS;
}

static SluiceResult make(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                         const SluiceAllocationCallbacks *cb, uint64_t size, uint32_t memory_type,
                         uint32_t *heap_id)
{
    uint32_t id = 0;
    while (id < heaps->capacity && heaps->at[id].memory.memory)
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
    if (slc_memory_allocate(vk, &request, &heaps->at[id].memory) != VK_SUCCESS)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    heaps->total_size += size;
    *heap_id = id;
    return SLUICE_SUCCESS;
}

void slc_device_heaps_prepare(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb, uint64_t size,
                              uint32_t memory_type, uint32_t max_count)
{
    uint32_t id;
    for (uint32_t count = 0; count < max_count || max_count == 0; count++) {
        if (heaps->total_size >= heaps->kept_size ||
            make(heaps, vk, cb, size, memory_type, &id) != SLUICE_SUCCESS)
            return;
        heaps->at[id].spare = true;
    }
}

SluiceResult slc_device_heaps_allocate(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                                       const SluiceAllocationCallbacks *cb, uint64_t size,
                                       uint32_t memory_type, uint32_t *heap_id)
{
    for (uint32_t id = 0; id < heaps->capacity; id++)
        if (heaps->at[id].spare && heaps->at[id].memory.size == size) {
            heaps->at[id].spare = false;
            *heap_id = id;
            return SLUICE_SUCCESS;
        }
    return make(heaps, vk, cb, size, memory_type, heap_id);
}

static void free_heap(struct slc_device_heaps *heaps, const struct slc_vk *vk, uint32_t id)
{
    heaps->total_size -= heaps->at[id].memory.size;
    heaps->at[id].spare = false;
    slc_memory_free(vk, &heaps->at[id].memory);
}

uint64_t slc_device_heaps_free_spare(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                                     uint64_t wanted)
{
    uint64_t before = heaps->total_size;
    for (uint32_t id = heaps->capacity; id-- > 0 && before - heaps->total_size < wanted;)
        if (heaps->at[id].spare)
            free_heap(heaps, vk, id);
    return before - heaps->total_size;
}

void slc_device_heaps_release(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                              uint32_t heap_id)
{
    assert(!heaps->at[heap_id].spare);
    if (heaps->total_size <= heaps->kept_size)
        heaps->at[heap_id].spare = true;
    else
        free_heap(heaps, vk, heap_id);
}

void slc_device_heaps_finish(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                             const SluiceAllocationCallbacks *cb)
{
    for (uint32_t id = 0; id < heaps->capacity; id++)
        if (heaps->at[id].memory.memory)
            free_heap(heaps, vk, id);
    slc_free(cb, heaps->at, heaps->capacity, sizeof *heaps->at);
    *heaps = (struct slc_device_heaps){0};
}
