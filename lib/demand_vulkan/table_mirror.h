/**
 * A part of a device buffer that the host writes element by element: a copy that grows with use,
 * and a bit per element that changed. What changed goes into the command buffer itself.
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
    uint64_t offset;                     ///< bytes, of element 0
    uint32_t max_count;                  ///< elements
    struct slc_mirror_element *elements; ///< owned; zero until written
    uint64_t *changed;                   ///< owned; a bit per element
    uint64_t *recorded;                  ///< owned; of those, by launches that are not over
    uint64_t recorded_launch;            ///< the last that recorded any; 0: none is set
    uint32_t capacity;                   ///< a multiple of 64
    uint32_t first_word, end_word;       ///< of `changed`: nothing is set outside
};

void slc_table_mirror_init(struct slc_table_mirror *mirror, const SluiceAllocationCallbacks *cb,
                           VkBuffer buffer, uint64_t offset, uint32_t max_count);
/** Of a zeroed one: nothing to do. */
void slc_table_mirror_finish(struct slc_table_mirror *mirror);

/** Room for elements below `count`. Errors: LIMIT_EXCEEDED, OUT_OF_HOST_MEMORY; nothing changed. */
SluiceResult slc_table_mirror_reserve(struct slc_table_mirror *mirror, uint32_t count);

/** For writing: the element goes to the device with the next record. It has room. */
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

/** Transfers of `launch`; the caller puts barriers around. */
void slc_table_mirror_record(struct slc_table_mirror *mirror, const struct slc_vk *vk,
                             VkCommandBuffer commands, uint64_t launch);
/** Launches up to this one are over. */
void slc_table_mirror_complete(struct slc_table_mirror *mirror, uint64_t launch);
/** Launches from this one on were never submitted: what they recorded, and perhaps more, has
 * changed again. */
void slc_table_mirror_abandon(struct slc_table_mirror *mirror, uint64_t launch);

#endif /* SLC_DEMAND_VULKAN_TABLE_MIRROR_H */
