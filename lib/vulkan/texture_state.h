/** Levels of a texture that shaders can sample in the last frame begun. */
#ifndef SLC_VULKAN_TEXTURE_STATE_H
#define SLC_VULKAN_TEXTURE_STATE_H

#include "vulkan/texture_rect.h"

/** Returns the state of a rectangle. `rect` is in texels of the MinMip map. */
SluiceVulkanTextureState slc_texture_state(const SluiceVulkanStreamer *s,
                                           const struct slc_texture *texture,
                                           const struct slc_tile_rect *rect);

#endif /* SLC_VULKAN_TEXTURE_STATE_H */
