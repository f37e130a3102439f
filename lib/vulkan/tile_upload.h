/** From staging slots to images. */
#ifndef SLC_VULKAN_TILE_UPLOAD_H
#define SLC_VULKAN_TILE_UPLOAD_H

#include "vulkan/streamer.h"

SluiceResult slc_tile_uploads_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);

/** Tells the manager that all packed tiles of the texture have their texels. */
SluiceResult slc_packed_publish(SluiceVulkanStreamer *s, uint32_t texture);

/** Sorts units by ascending key. */
void slc_sort_units(const SluiceVulkanStreamer *s, uint32_t *units, uint32_t count,
                    uint64_t (*key)(const SluiceVulkanStreamer *s, uint32_t unit));

#endif /* SLC_VULKAN_TILE_UPLOAD_H */
