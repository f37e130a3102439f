/** Copies of units from their staging slots. */
#ifndef SLC_VULKAN_UNIT_COPIES_H
#define SLC_VULKAN_UNIT_COPIES_H

#include "vulkan/streamer.h"

/** How many units, from the first one on, are of its texture and staging buffer, and copied or not
 *  as it is. */
uint32_t slc_unit_group(const SluiceVulkanStreamer *s, const uint32_t *units, uint32_t count);

/** Records the copies of a group, or what shows its tiles; `parts` are of slc_upload_part. */
void slc_record_group(SluiceVulkanStreamer *s, VkCommandBuffer commands, const uint32_t *units,
                      uint32_t count, uint32_t parts);

/** True if copies of two commands to the texture must have a barrier between them. */
bool slc_copies_need_barriers(const SluiceVulkanStreamer *s, uint32_t texture);

/** Sorts units by ascending key. */
void slc_sort_units(const SluiceVulkanStreamer *s, uint32_t *units, uint32_t count,
                    uint64_t (*key)(const SluiceVulkanStreamer *s, uint32_t unit));

#endif /* SLC_VULKAN_UNIT_COPIES_H */
