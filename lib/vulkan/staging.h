/**
 * Staging slots of one tile each, in blocks of 4 MiB. The host writes them, the GPU copies from
 * them. A block is made when one of its slots is first needed. The user chooses slots, and should
 * prefer recently used ones.
 *
 * The staging memories of a group share blocks: a member that needs a block takes an idle block of
 * another member before it allocates. A group keeps a certain size: its members allocate it at
 * their start, and free idle blocks only beyond it. Each member's first block is made at its start
 * and never taken or freed, so that every member can always upload.
 */
#ifndef SLC_VULKAN_STAGING_H
#define SLC_VULKAN_STAGING_H

#include "vulkan/buffer.h"
#include "platform/thread.h"

#define SLC_STAGING_BLOCK_SLOTS 64u

struct slc_staging_block {
    struct slc_buffer buffer; ///< zeroed: not made yet
    uint32_t used_count;      ///< slots
    uint64_t idle_since;      ///< tick in which the last slot was given back
};

struct slc_staging;

struct slc_staging_group {
    struct slc_mutex mutex; ///< guards the blocks of all members
    struct slc_staging *first;
    uint64_t kept_size; ///< bytes of blocks that stay while they are idle
    uint64_t size;      ///< bytes of all blocks
};

struct slc_staging {
    struct slc_staging_group *group; ///< borrowed
    struct slc_staging *next;        ///< next member of the group
    const struct slc_vk *vk;
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    struct slc_staging_block *blocks; ///< owned
    uint32_t block_count, slot_count;
    uint64_t tick;
    bool refused; ///< the device refused memory; it is asked again after the next tick
};

/** Makes a group that keeps at least `kept_size` bytes, if its members have as many slots. */
void slc_staging_group_init(struct slc_staging_group *group, uint64_t kept_size);
/** Finishes a group without members. */
void slc_staging_group_finish(struct slc_staging_group *group);

/**
 * Makes the first block, and more until the group has the size that it keeps. Errors:
 * OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN; finish it then, too.
 */
SluiceResult slc_staging_init(struct slc_staging *staging, struct slc_staging_group *group,
                              const struct slc_vk *vk, const struct slc_caps *caps,
                              const SluiceAllocationCallbacks *cb, uint32_t slot_count);
/** Frees the blocks. Neither threads nor the GPU may use them any more. */
void slc_staging_finish(struct slc_staging *staging);

/** True if a slot has memory. */
bool slc_staging_is_there(const struct slc_staging *staging, uint32_t slot);
/** Gives a slot memory; false if there is none now. */
bool slc_staging_ensure(struct slc_staging *staging, uint32_t slot);
/** Marks a slot as used. It must have memory, and keeps it until slc_staging_give. */
void slc_staging_take(struct slc_staging *staging, uint32_t slot);
/** Gives a slot back. No frame in progress may read it. */
void slc_staging_give(struct slc_staging *staging, uint32_t slot);
/** Frees blocks that were unused for 120 frames, except blocks that the group keeps. Call it once
 * per frame. */
void slc_staging_trim(struct slc_staging *staging);

/** Memory and buffer of a slot, which must have memory. */
uint8_t *slc_staging_memory(const struct slc_staging *staging, uint32_t slot);
VkBuffer slc_staging_buffer(const struct slc_staging *staging, uint32_t slot);
uint64_t slc_staging_offset(uint32_t slot); ///< bytes, in the slot's buffer
/** Returns the block of a slot. Slots of one block have one buffer. */
uint32_t slc_staging_block(uint32_t slot);

#endif /* SLC_VULKAN_STAGING_H */
