/**
 * Logs once that a source cannot be read, and once that it can be read again. Failures between are
 * counted in the statistics: a file with 182 damaged tiles gives two lines, not hundreds.
 */
#ifndef SLC_VULKAN_READ_TROUBLES_H
#define SLC_VULKAN_READ_TROUBLES_H

#include "vulkan/streamer.h"

/**
 * Notes a failed read of `count` tiles, which the manager knows. `tile` is one of them. Tiles of a
 * source that is not ready yet are counted separately, without a message.
 */
void slc_read_trouble_failed(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile,
                             uint32_t count, SluiceResult result);
/** Notes a successful read of `tile`. After a recovery other layers are tried again. */
void slc_read_trouble_delivered(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile);

#endif /* SLC_VULKAN_READ_TROUBLES_H */
