/** Copies of texels from staging slots to images. */
#ifndef SLC_VULKAN_TILE_UPLOAD_H
#define SLC_VULKAN_TILE_UPLOAD_H

#include "vulkan/streamer.h"

SluiceResult slc_tile_uploads_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);

/** Tells the manager that all packed tiles of the texture have their texels. */
SluiceResult slc_packed_publish(SluiceVulkanStreamer *s, uint32_t texture);

#endif /* SLC_VULKAN_TILE_UPLOAD_H */
