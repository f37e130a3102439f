#include "vulkan/readback_ring.h"

#include "base/alloc.h"

#include <assert.h>

SluiceResult slc_readback_ring_init(struct slc_readback_ring *ring, const struct slc_vk *vk,
                                    const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb, uint32_t slot_count,
                                    uint32_t items_per_slot, uint32_t slot_size)
{
    *ring = (struct slc_readback_ring){.slot_count = slot_count,
                                       .items_per_slot = items_per_slot,
                                       .slot_size = (slot_size + 3) & ~3u};
    ring->slots = slc_calloc(cb, slot_count, sizeof *ring->slots);
    ring->items = slc_calloc(cb, (size_t)slot_count * items_per_slot, sizeof *ring->items);
    if (!ring->slots || !ring->items)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < slot_count; i++)
        ring->slots[i].items = &ring->items[(size_t)i * items_per_slot];
    return slc_buffer_init(&ring->buffer, vk, caps, (uint64_t)slot_count * ring->slot_size,
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, SLC_BUFFER_READBACK);
}

void slc_readback_ring_finish(struct slc_readback_ring *ring, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb)
{
    slc_buffer_finish(&ring->buffer, vk);
    slc_free(cb, ring->slots, ring->slot_count, sizeof *ring->slots);
    slc_free(cb, ring->items, (size_t)ring->slot_count * ring->items_per_slot, sizeof *ring->items);
    *ring = (struct slc_readback_ring){0};
}

struct slc_readback_slot *slc_readback_begin(struct slc_readback_ring *ring, uint64_t frame,
                                             uint64_t time_stamp)
{
    struct slc_readback_slot *slot = &ring->slots[frame % ring->slot_count];
    assert(slot->frame == 0);
    slot->frame = frame;
    slot->time_stamp = time_stamp;
    slot->item_count = slot->used = 0;
    return slot;
}

bool slc_readback_add(struct slc_readback_ring *ring, struct slc_readback_slot *slot,
                      SluiceTextureId id, uint32_t width, uint32_t height, uint32_t *word)
{
    uint64_t size = ((uint64_t)width * height + 3) & ~(uint64_t)3;
    if (slot->item_count == ring->items_per_slot || size > ring->slot_size - slot->used)
        return false;
    slot->items[slot->item_count++] = (struct slc_readback_item){id, slot->used, width, height};
    *word = (uint32_t)((slot - ring->slots) * (ring->slot_size / 4)) + slot->used / 4;
    slot->used += (uint32_t)size;
    return true;
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

const uint8_t *slc_readback_map(const struct slc_readback_ring *ring,
                                const struct slc_readback_slot *slot, uint32_t item)
{
    const uint8_t *bytes = ring->buffer.mapped;
    return bytes + (size_t)(slot - ring->slots) * ring->slot_size + slot->items[item].offset;
}
