/** Textures whose maps the manager gets in the next frame, even if no feedback arrives. */
#ifndef SLC_VULKAN_DUE_MAPS_H
#define SLC_VULKAN_DUE_MAPS_H

#include "vulkan/streamer.h"

/** Makes room for a map that differs from the texture's feedback. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_due_map_reserve(SluiceVulkanStreamer *s, const struct slc_texture *texture);

/** Adds a texture, which must follow no other one. */
void slc_due_map_add(SluiceVulkanStreamer *s, struct slc_texture *texture);
/** Removes a texture that is being removed. */
void slc_due_map_drop(SluiceVulkanStreamer *s, struct slc_texture *texture);

#endif /* SLC_VULKAN_DUE_MAPS_H */
