/**
 * Slots of one tile each that the host writes and the GPU copies from, in blocks of 4 MiB. A block
 * is made when a slot of it is first needed. The user chooses slots, and should prefer those that
 * were used last.
 *
 * The staging memories of a group share blocks: one that needs a block takes an idle one from
 * another before it allocates. A group keeps some memory: its members make it at their start, and
 * free idle blocks only beyond that size. The first block of each member is its own, made at its
 * start and never taken or freed, so that every member can always upload.
 */
#ifndef SLC_VULKAN_STAGING_H
#define SLC_VULKAN_STAGING_H

#include "vulkan/buffer.h"
#include "platform/thread.h"

#define SLC_STAGING_BLOCK_SLOTS 64u

struct slc_staging_block {
    struct slc_buffer buffer; ///< none: not made yet
    uint32_t used_count;      ///< slots
    uint64_t idle_since;      ///< tick of slc_staging_trim
};

struct slc_staging;

struct slc_staging_group {
    struct slc_mutex mutex; ///< around the blocks of all members
    struct slc_staging *first;
    uint64_t kept_size; ///< bytes of blocks that stay while they are idle
    uint64_t size;      ///< bytes of all blocks
};

struct slc_staging {
    struct slc_staging_group *group; ///< borrowed
    struct slc_staging *next;        ///< of the group
    const struct slc_vk *vk;
    const struct slc_caps *caps;
    const SluiceAllocationCallbacks *cb;
    struct slc_staging_block *blocks; ///< owned
    uint32_t block_count, slot_count;
    uint64_t tick;
    bool refused; ///< since the last tick: the device is not asked again before the next
};

/** Keeps at least `kept_size` bytes, if its members have as many slots. */
void slc_staging_group_init(struct slc_staging_group *group, uint64_t kept_size);
/** It has no members. */
void slc_staging_group_finish(struct slc_staging_group *group);

/**
 * Makes the first block, and more until the group has what it keeps. Errors:
 * OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN; finish it then, too.
 */
SluiceResult slc_staging_init(struct slc_staging *staging, struct slc_staging_group *group,
                              const struct slc_vk *vk, const struct slc_caps *caps,
                              const SluiceAllocationCallbacks *cb, uint32_t slot_count);
/** Threads no longer write into it and the GPU no longer reads it. */
void slc_staging_finish(struct slc_staging *staging);

/** Whether a slot has memory. */
bool slc_staging_is_there(const struct slc_staging *staging, uint32_t slot);
/** Gives it memory; false if there is none now. */
bool slc_staging_ensure(struct slc_staging *staging, uint32_t slot);
/** Of one that has memory, which it keeps until it is given back. */
void slc_staging_take(struct slc_staging *staging, uint32_t slot);
/** No frame under way reads it. */
void slc_staging_give(struct slc_staging *staging, uint32_t slot);
/** Once per frame: frees blocks that nobody used for 120 frames, except those that the group keeps.
 */
void slc_staging_trim(struct slc_staging *staging);

/** Of one that has memory. */
uint8_t *slc_staging_memory(const struct slc_staging *staging, uint32_t slot);
VkBuffer slc_staging_buffer(const struct slc_staging *staging, uint32_t slot);
uint64_t slc_staging_offset(uint32_t slot); ///< in that buffer
/** Equal for slots of one buffer. */
uint32_t slc_staging_block(uint32_t slot);

#endif /* SLC_VULKAN_STAGING_H */
