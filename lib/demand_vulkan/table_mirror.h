/**
 * Host mirror of a part of a device buffer, written element by element. The mirror grows with use,
 * and has a bit per changed element. Changed elements are recorded into the command buffer itself.
 */
#ifndef SLC_DEMAND_VULKAN_TABLE_MIRROR_H
#define SLC_DEMAND_VULKAN_TABLE_MIRROR_H

#include "vulkan/buffer.h"

#define SLC_MIRROR_ELEMENT 64u /* bytes */

struct slc_mirror_element {
    uint32_t words[SLC_MIRROR_ELEMENT / 4];
};

struct slc_table_mirror {
    const SluiceAllocationCallbacks *cb;
    VkBuffer buffer;                     ///< borrowed
    uint64_t offset;                     ///< byte offset of element 0
    uint32_t max_count;                  ///< elements
    struct slc_mirror_element *elements; ///< owned; zero until written
    uint64_t *changed;                   ///< owned; one bit per element
    uint64_t *recorded;                  ///< owned; bits of changes recorded by incomplete launches
    uint64_t recorded_launch;            ///< last launch that recorded changes; 0: no bit is set
    uint32_t capacity;                   ///< a multiple of 64
    uint32_t first_word, end_word;       ///< range of words of `changed` with set bits
};

void slc_table_mirror_init(struct slc_table_mirror *mirror, const SluiceAllocationCallbacks *cb,
                           VkBuffer buffer, uint64_t offset, uint32_t max_count);
/** Frees the mirror. It may be zeroed. */
void slc_table_mirror_finish(struct slc_table_mirror *mirror);

/** Reserves elements below `count`. Errors, with nothing changed: LIMIT_EXCEEDED,
 * OUT_OF_HOST_MEMORY. */
SluiceResult slc_table_mirror_reserve(struct slc_table_mirror *mirror, uint32_t count);

/** Returns a reserved element for writing. The device gets it with the next record. */
void *slc_table_mirror_change(struct slc_table_mirror *mirror, uint32_t index);
static inline const void *slc_table_mirror_get(const struct slc_table_mirror *mirror,
                                               uint32_t index)
{
    return &mirror->elements[index];
}

static inline bool slc_table_mirror_has_changes(const struct slc_table_mirror *mirror)
{
    return mirror->first_word < mirror->end_word;
}

/** Records transfers of changes in `launch`. The caller records barriers around them. */
void slc_table_mirror_record(struct slc_table_mirror *mirror, const struct slc_vk *vk,
                             VkCommandBuffer commands, uint64_t launch);
/** Notes that launches up to this one are complete. */
void slc_table_mirror_complete(struct slc_table_mirror *mirror, uint64_t launch);
/** Abandons launches from this one on, which were never submitted: marks at least the elements that
 * they recorded as changed. */
void slc_table_mirror_abandon(struct slc_table_mirror *mirror, uint64_t launch);

#endif /* SLC_DEMAND_VULKAN_TABLE_MIRROR_H */
