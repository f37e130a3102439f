/**
 * Resolve: compute passes that compare feedback with the levels resolved last, write the changes
 * into a readback slot, and clear reported feedback (shaders/resolve). Three dispatches for any
 * number of textures.
 */
#ifndef SLC_VULKAN_RESOLVE_H
#define SLC_VULKAN_RESOLVE_H

#include "vulkan/buffer.h"
#include "vulkan/compute.h"

#include <sluice/shared/resolve.h>

struct slc_resolve_create_info {
    VkBuffer feedback, readback; ///< whole storage buffers
    uint32_t region_capacity;    ///< regions of the feedback buffer, a multiple of 4
    uint32_t slot_count;         ///< frames in flight
    uint32_t max_items;          ///< per frame
    uint32_t encoding;           ///< SLUICE_FEEDBACK_...
};

struct slc_resolve {
    struct slc_buffer last;     ///< one byte per region: level resolved last
    struct slc_buffer table;    ///< one slot per frame in flight: max_segments segments, then items
    struct slc_buffer scratch;  ///< for one frame: sums of the segments, then offsets of the items
    struct slc_compute compute; ///< passes count, scan, write
    uint32_t max_segments, max_items;
    uint32_t slot; ///< slot that is being filled
    uint32_t segment_count, item_count;
};

/** Return the bytes of the table and of the scratch buffer, for comparing with limits. */
uint64_t slc_resolve_table_size(const struct slc_resolve_create_info *info);
uint64_t slc_resolve_scratch_size(const struct slc_resolve_create_info *info);

SluiceResult slc_resolve_init(struct slc_resolve *resolve, const struct slc_vk *vk,
                              const struct slc_caps *caps,
                              const struct slc_resolve_create_info *info);
void slc_resolve_finish(struct slc_resolve *resolve, const struct slc_vk *vk);

/** Records that the last resolved level of a new texture's regions is SLUICE_MIP_UNTOUCHED. The
 *  caller records barriers around this transfer. */
void slc_resolve_record_new(const struct slc_resolve *resolve, const struct slc_vk *vk,
                            VkCommandBuffer commands, uint32_t first_region, uint32_t region_count);

/** Begins a frame's list of items in `slot`, which no frame under way uses. */
void slc_resolve_begin(struct slc_resolve *resolve, uint32_t slot);
/** Uses the last list of `slot` again, which has these counts. */
void slc_resolve_resume(struct slc_resolve *resolve, uint32_t slot, uint32_t item_count,
                        uint32_t segment_count);
/** Adds an item. `first_region` is a multiple of 4; flags SLUICE_RESOLVE_... False if the list is
 *  full. It has room for max_items items, if no region is in two of them. */
bool slc_resolve_add(struct slc_resolve *resolve, uint32_t first_region, uint32_t region_count,
                     uint32_t flags);
/**
 * Records the resolve of all items: results at word `result_offset` of the readback buffer, a
 * multiple of 4, data from word `data_offset` on, at most `capacity` words. Includes barriers
 * against earlier shaders, and against later shaders and the host.
 */
void slc_resolve_record(const struct slc_resolve *resolve, const struct slc_vk *vk,
                        VkCommandBuffer commands, uint32_t result_offset, uint32_t data_offset,
                        uint32_t capacity);

#endif /* SLC_VULKAN_RESOLVE_H */
