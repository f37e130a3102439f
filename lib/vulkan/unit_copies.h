/** Copies of units from their staging slots. */
#ifndef SLC_VULKAN_UNIT_COPIES_H
#define SLC_VULKAN_UNIT_COPIES_H

#include "vulkan/streamer.h"

/** Returns how many units, from the first one on, have equal texture, staging buffer and `copied`.
 */
uint32_t slc_unit_group(const SluiceVulkanStreamer *s, const uint32_t *units, uint32_t count);

/** Records copies of a group, or the display of its tiles. `parts`: bits of slc_upload_part. */
void slc_record_group(SluiceVulkanStreamer *s, VkCommandBuffer commands, const uint32_t *units,
                      uint32_t count, uint32_t parts);

/** True if consecutive copy commands to the texture require a barrier between them. */
bool slc_copies_need_barriers(const SluiceVulkanStreamer *s, uint32_t texture);

/** Sorts units by ascending key. */
void slc_sort_units(const SluiceVulkanStreamer *s, uint32_t *units, uint32_t count,
                    uint64_t (*key)(const SluiceVulkanStreamer *s, uint32_t unit));

#endif /* SLC_VULKAN_UNIT_COPIES_H */
