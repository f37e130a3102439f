/** What the manager gets of a texture in place of what shaders marked. */
#ifndef SLC_VULKAN_TEXTURE_CONTROL_H
#define SLC_VULKAN_TEXTURE_CONTROL_H

#include "vulkan/streamer.h"

/** Of a texture that goes: nothing more is given of it. */
void slc_control_drop(SluiceVulkanStreamer *s, struct slc_texture *texture);

/** Sets the priority of a texture and of its followers. */
void slc_control_set_priority(SluiceVulkanStreamer *s, struct slc_texture *texture,
                              int32_t priority);

/** Returns the map to give: the feedback, or what is made of it. Valid until the next call. */
const uint8_t *slc_control_map(SluiceVulkanStreamer *s, const struct slc_texture *texture);

#endif /* SLC_VULKAN_TEXTURE_CONTROL_H */
