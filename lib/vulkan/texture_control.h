/** Maps for the manager: feedback changed by requests and the application's control of textures. */
#ifndef SLC_VULKAN_TEXTURE_CONTROL_H
#define SLC_VULKAN_TEXTURE_CONTROL_H

#include "vulkan/streamer.h"

/** Drops the control of a texture that is removed. The manager gets no more maps of it. */
void slc_control_drop(SluiceVulkanStreamer *s, struct slc_texture *texture);

/** Sets the priority of a texture and of its followers. */
void slc_control_set_priority(SluiceVulkanStreamer *s, struct slc_texture *texture,
                              int32_t priority);

/** Returns the map for the manager: the feedback, or a changed copy. Valid until the next call. */
const uint8_t *slc_control_map(SluiceVulkanStreamer *s, const struct slc_texture *texture);

#endif /* SLC_VULKAN_TEXTURE_CONTROL_H */
