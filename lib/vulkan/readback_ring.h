/**
 * Resolved feedback on its way to the host: one slot per frame in flight, in host memory, written
 * by the resolve passes of its frame and read when that frame is over.
 */
#ifndef SLC_VULKAN_READBACK_RING_H
#define SLC_VULKAN_READBACK_RING_H

#include "vulkan/buffer.h"

#include <sluice/shared/resolve.h>

struct slc_readback_slot {
    uint64_t frame; ///< 0: empty
    uint64_t time_stamp;
    /** What was resolved into it last, which may be what is resolved into it next. */
    uint32_t item_count, segment_count;
    SluiceTextureId *items;        ///< part of slc_readback_ring.items
    uint64_t list_version;         ///< SluiceVulkanStreamer.list_version at that time; 0: none
    uint32_t list_first, list_end; ///< cursors before and after
    bool share_of_all;             ///< some items are there because all textures are asked for
};

/** In the buffer a slot is max_items results and then `capacity` words that they name. */
struct slc_readback_ring {
    struct slc_buffer buffer;
    struct slc_readback_slot *slots; ///< owned
    SluiceTextureId *items;          ///< owned
    uint32_t slot_count, max_items;
    uint32_t capacity;
};

/** Bytes of the buffer, for comparing with limits. */
uint64_t slc_readback_ring_size(uint32_t slot_count, uint32_t max_items, uint32_t capacity);

SluiceResult slc_readback_ring_init(struct slc_readback_ring *ring, const struct slc_vk *vk,
                                    const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb, uint32_t slot_count,
                                    uint32_t max_items, uint32_t capacity);
void slc_readback_ring_finish(struct slc_readback_ring *ring, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb);

/** A slot whose last frame was read or abandoned; its items are those of that frame. */
struct slc_readback_slot *slc_readback_begin(struct slc_readback_ring *ring, uint32_t index,
                                             uint64_t frame, uint64_t time_stamp);
/** Words of the buffer: where the slot's results are, and where what they name is. */
uint32_t slc_readback_result_offset(const struct slc_readback_ring *ring,
                                    const struct slc_readback_slot *slot);
uint32_t slc_readback_data_offset(const struct slc_readback_ring *ring,
                                  const struct slc_readback_slot *slot);
/** The oldest slot whose frame is at most `completed_frame`, or NULL. Set its frame to 0 when read.
 */
struct slc_readback_slot *slc_readback_oldest(struct slc_readback_ring *ring,
                                              uint64_t completed_frame);
/** What the device wrote for one item; NULL in place of `*data` if that is outside of the slot. */
struct SluiceResolveResult slc_readback_result(const struct slc_readback_ring *ring,
                                               const struct slc_readback_slot *slot, uint32_t item,
                                               const uint32_t **data);

#endif /* SLC_VULKAN_READBACK_RING_H */
