/** Textures of which the manager gets a map in the next frame, also if no feedback arrives. */
#ifndef SLC_VULKAN_DUE_MAPS_H
#define SLC_VULKAN_DUE_MAPS_H

#include "vulkan/streamer.h"

/** Makes room for a map that is not the texture's feedback alone. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_due_map_reserve(SluiceVulkanStreamer *s, const struct slc_texture *texture);

/** Of a texture that follows no other one. */
void slc_due_map_add(SluiceVulkanStreamer *s, struct slc_texture *texture);
/** Of a texture that goes. */
void slc_due_map_drop(SluiceVulkanStreamer *s, struct slc_texture *texture);

#endif /* SLC_VULKAN_DUE_MAPS_H */
