/** From staging slots to images. */
#ifndef SLC_VULKAN_TILE_UPLOAD_H
#define SLC_VULKAN_TILE_UPLOAD_H

#include "vulkan/streamer.h"

SluiceResult slc_tile_uploads_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);

#endif /* SLC_VULKAN_TILE_UPLOAD_H */
