/** UV transforms of followers relative to their primaries. */
#ifndef SLC_VULKAN_TEXTURE_PRIMARY_H
#define SLC_VULKAN_TEXTURE_PRIMARY_H

#include "vulkan/streamer.h"

/** Sets the transform in the manager, with the texture's address modes. The manager must not be
 *  locked. Errors: INVALID_ARGUMENT, logged; OUT_OF_HOST_MEMORY. */
SluiceResult slc_texture_set_uv(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                                const SluiceUvTransform *transform);

#endif /* SLC_VULKAN_TEXTURE_PRIMARY_H */
