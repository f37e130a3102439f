/**
 * Says once that a source cannot be read, and once that it can be read again. Everything between is
 * counted in the statistics: a file with 182 damaged tiles is two lines, not hundreds.
 */
#ifndef SLC_VULKAN_READ_TROUBLES_H
#define SLC_VULKAN_READ_TROUBLES_H

#include "vulkan/streamer.h"

/**
 * A read of the texture for `count` tiles failed, and the manager was told. `tile` is one of them.
 * Counts them. A source that is not ready yet is no trouble: its tiles are counted apart.
 */
void slc_read_trouble_failed(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile,
                             uint32_t count, SluiceResult result);
/** A read of the texture delivered `tile`. After a recovery other layers are tried again. */
void slc_read_trouble_delivered(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile);

#endif /* SLC_VULKAN_READ_TROUBLES_H */
