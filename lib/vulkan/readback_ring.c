#include "vulkan/readback_ring.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

#define RESULT_WORDS 4u

/* Returns the words of a slot, rounded up to whole results, so that the next slot is aligned. */
static uint32_t slot_words(uint32_t max_items, uint32_t capacity)
{
    return RESULT_WORDS * (max_items + slc_div_up_u32(capacity, RESULT_WORDS));
}

uint64_t slc_readback_ring_size(uint32_t slot_count, uint32_t max_items, uint32_t capacity)
{
    return (uint64_t)slot_count * slot_words(max_items, capacity) * 4;
}

SluiceResult slc_readback_ring_init(struct slc_readback_ring *ring, const struct slc_vk *vk,
                                    const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb, uint32_t slot_count,
                                    uint32_t max_items, uint32_t capacity)
{
    *ring = (struct slc_readback_ring){
        .slot_count = slot_count, .max_items = max_items, .capacity = capacity};
    ring->slots = slc_calloc(cb, slot_count, sizeof *ring->slots);
    ring->items = slc_calloc(cb, (size_t)slot_count * max_items, sizeof *ring->items);
    if (!ring->slots || !ring->items)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < slot_count; i++)
        ring->slots[i].items = &ring->items[(size_t)i * max_items];
    return slc_buffer_init(&ring->buffer, vk, caps,
                           slc_readback_ring_size(slot_count, max_items, capacity),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, SLC_BUFFER_READBACK);
}

void slc_readback_ring_finish(struct slc_readback_ring *ring, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb)
{
    slc_buffer_finish(&ring->buffer, vk);
    slc_free(cb, ring->slots, ring->slot_count, sizeof *ring->slots);
    slc_free(cb, ring->items, (size_t)ring->slot_count * ring->max_items, sizeof *ring->items);
    *ring = (struct slc_readback_ring){0};
}

struct slc_readback_slot *slc_readback_begin(struct slc_readback_ring *ring, uint32_t index,
                                             uint64_t frame, uint64_t time_stamp)
{
    struct slc_readback_slot *slot = &ring->slots[index];
    assert(index < ring->slot_count && slot->frame == 0);
    slot->frame = frame;
    slot->time_stamp = time_stamp;
    return slot;
}

uint32_t slc_readback_result_offset(const struct slc_readback_ring *ring,
                                    const struct slc_readback_slot *slot)
{
    return (uint32_t)(slot - ring->slots) * slot_words(ring->max_items, ring->capacity);
}

uint32_t slc_readback_data_offset(const struct slc_readback_ring *ring,
                                  const struct slc_readback_slot *slot)
{
    return slc_readback_result_offset(ring, slot) + RESULT_WORDS * ring->max_items;
}

struct slc_readback_slot *slc_readback_oldest(struct slc_readback_ring *ring,
                                              uint64_t completed_frame)
{
    struct slc_readback_slot *oldest = NULL;
    for (uint32_t i = 0; i < ring->slot_count; i++) {
        struct slc_readback_slot *slot = &ring->slots[i];
        if (slot->frame && slot->frame <= completed_frame &&
            (!oldest || slot->frame < oldest->frame))
            oldest = slot;
    }
    return oldest;
}

struct SluiceResolveResult slc_readback_result(const struct slc_readback_ring *ring,
                                               const struct slc_readback_slot *slot, uint32_t item,
                                               const uint32_t **data)
{
    const uint32_t *words = ring->buffer.mapped;
    struct SluiceResolveResult result;
    memcpy(&result, &words[slc_readback_result_offset(ring, slot) + RESULT_WORDS * item],
           sizeof result);
    bool inside = result.offset <= ring->capacity && result.count <= ring->capacity - result.offset;
    *data = inside ? &words[slc_readback_data_offset(ring, slot) + result.offset] : NULL;
    return result;
}
