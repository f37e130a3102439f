/**
 * Feedback maps on their way to the host: one slot per frame in flight, in host memory, written by
 * the resolve pass of its frame and read when that frame is over.
 */
#ifndef SLC_VULKAN_READBACK_RING_H
#define SLC_VULKAN_READBACK_RING_H

#include "vulkan/buffer.h"

struct slc_readback_item {
    SluiceTextureId id;
    uint32_t offset; ///< bytes in the slot
    uint32_t width, height;
};

struct slc_readback_slot {
    uint64_t frame; ///< 0: empty
    uint64_t time_stamp;
    uint32_t item_count;
    uint32_t used;                   ///< bytes
    struct slc_readback_item *items; ///< part of slc_readback_ring.items
};

struct slc_readback_ring {
    struct slc_buffer buffer;
    struct slc_readback_slot *slots; ///< owned
    struct slc_readback_item *items; ///< owned
    uint32_t slot_count, items_per_slot;
    uint32_t slot_size; ///< bytes, a multiple of 4
};

SluiceResult slc_readback_ring_init(struct slc_readback_ring *ring, const struct slc_vk *vk,
                                    const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb, uint32_t slot_count,
                                    uint32_t items_per_slot, uint32_t slot_size);
void slc_readback_ring_finish(struct slc_readback_ring *ring, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb);

/** The slot of `frame`, which must have been read; empty from here on. */
struct slc_readback_slot *slc_readback_begin(struct slc_readback_ring *ring, uint64_t frame,
                                             uint64_t time_stamp);
/** False if the map has no room in this slot. `*word` is its place in the whole buffer. */
bool slc_readback_add(struct slc_readback_ring *ring, struct slc_readback_slot *slot,
                      SluiceTextureId id, uint32_t width, uint32_t height, uint32_t *word);
/** The oldest slot whose frame is at most `completed_frame`, or NULL. Set its frame to 0 when read.
 */
struct slc_readback_slot *slc_readback_oldest(struct slc_readback_ring *ring,
                                              uint64_t completed_frame);
const uint8_t *slc_readback_map(const struct slc_readback_ring *ring,
                                const struct slc_readback_slot *slot, uint32_t item);

#endif /* SLC_VULKAN_READBACK_RING_H */
