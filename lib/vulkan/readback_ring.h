/**
 * Readback of resolved feedback: one slot per frame in flight, in host memory. The resolve passes
 * of a frame write the slot. The host reads it when the frame is complete.
 */
#ifndef SLC_VULKAN_READBACK_RING_H
#define SLC_VULKAN_READBACK_RING_H

#include "vulkan/buffer.h"

#include <sluice/shared/resolve.h>

struct slc_readback_slot {
    uint64_t frame; ///< 0: empty
    uint64_t time_stamp;
    /** The last list of resolves, which the next frame of the slot may use again. */
    uint32_t item_count, segment_count;
    SluiceTextureId *items;        ///< part of slc_readback_ring.items
    uint64_t list_version;         ///< the streamer's list_version when the list was made; 0: none
    uint32_t list_first, list_end; ///< primary_cursor before and after the list was made
    bool share_of_all;             ///< some items are turns of sluiceResolveAllVulkanTextures
};

/** Ring of slots. In the buffer a slot has max_items results, then `capacity` words of their data.
 */
struct slc_readback_ring {
    struct slc_buffer buffer;
    struct slc_readback_slot *slots; ///< owned
    SluiceTextureId *items;          ///< owned
    uint32_t slot_count, max_items;
    uint32_t capacity;
};

/** Returns the bytes of the buffer, for comparing with limits. */
uint64_t slc_readback_ring_size(uint32_t slot_count, uint32_t max_items, uint32_t capacity);

SluiceResult slc_readback_ring_init(struct slc_readback_ring *ring, const struct slc_vk *vk,
                                    const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb, uint32_t slot_count,
                                    uint32_t max_items, uint32_t capacity);
void slc_readback_ring_finish(struct slc_readback_ring *ring, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb);

/** Begins a slot whose last frame was read or abandoned. Keeps the items of that frame. */
struct slc_readback_slot *slc_readback_begin(struct slc_readback_ring *ring, uint32_t index,
                                             uint64_t frame, uint64_t time_stamp);
/** Offsets in words of the slot's results and of their data. */
uint32_t slc_readback_result_offset(const struct slc_readback_ring *ring,
                                    const struct slc_readback_slot *slot);
uint32_t slc_readback_data_offset(const struct slc_readback_ring *ring,
                                  const struct slc_readback_slot *slot);
/** Returns the oldest slot whose frame is at most `completed_frame`, or NULL. Set its frame to 0
 * when read. */
struct slc_readback_slot *slc_readback_oldest(struct slc_readback_ring *ring,
                                              uint64_t completed_frame);
/** Returns the result of one item. `*data` is NULL if the result's data is outside of the slot. */
struct SluiceResolveResult slc_readback_result(const struct slc_readback_ring *ring,
                                               const struct slc_readback_slot *slot, uint32_t item,
                                               const uint32_t **data);

#endif /* SLC_VULKAN_READBACK_RING_H */
