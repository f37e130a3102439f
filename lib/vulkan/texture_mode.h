/** Choice of a texture's residency: the streamer's main one, the one for paged textures beside it,
 * or the one for images with all levels. */
#ifndef SLC_VULKAN_TEXTURE_MODE_H
#define SLC_VULKAN_TEXTURE_MODE_H

#include "vulkan/streamer.h"

/** Logs a mode that the streamer does not have. Errors: UNSUPPORTED. */
SluiceResult slc_texture_check_mode(const SluiceVulkanStreamer *s, SluiceResidencyMode mode);

/** Creates the image of a texture, and of all layers of an array, in the residency that holds it.
 */
SluiceResult slc_texture_create_image(SluiceVulkanStreamer *s, uint32_t first,
                                      SluiceResidencyMode mode, const SluiceImageInfo *image,
                                      const struct slc_image_use *use,
                                      struct slc_residency **residency,
                                      struct slc_residency_image *out);

/** Creates an image of one layer like slc_texture_create_image. But a dense texture stays dense: if
 *  memory is short, no other residency is tried. */
SluiceResult slc_texture_try_image(SluiceVulkanStreamer *s, uint32_t index,
                                   SluiceResidencyMode mode, const SluiceImageInfo *image,
                                   struct slc_residency **residency,
                                   struct slc_residency_image *out);

/** Returns the mode of a texture whose layout is known: DENSE if one image has all of its levels.
 */
SluiceResidencyMode slc_texture_mode(const SluiceVulkanStreamer *s,
                                     const struct slc_texture *texture);

#endif /* SLC_VULKAN_TEXTURE_MODE_H */
