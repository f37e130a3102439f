/** What shaders see of a texture. */
#ifndef SLC_VULKAN_TEXTURE_STATE_H
#define SLC_VULKAN_TEXTURE_STATE_H

#include "vulkan/texture_rect.h"

/** Of a rectangle in texels of the MinMip map. */
SluiceVulkanTextureState slc_texture_state(const SluiceVulkanStreamer *s,
                                           const struct slc_texture *texture,
                                           const struct slc_tile_rect *rect);

#endif /* SLC_VULKAN_TEXTURE_STATE_H */
