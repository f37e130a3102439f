/**
 * Textures that are forgotten while nobody samples them: image, views and tiles go, and a record
 * on the host stays, with its regions of feedback. They are as before when feedback asks for them.
 *
 *     PRESENT     has an image
 *     LEAVING     shaders do not see it from a frame on; the image waits for the frames before
 *     FORGOTTEN   has no image
 *
 * docs/decisions/0077-streamers-forget-textures.md has the rules.
 */
#ifndef SLC_VULKAN_TEXTURE_FORGETTING_H
#define SLC_VULKAN_TEXTURE_FORGETTING_H

#include "vulkan/streamer.h"

/** Whether a texture with this description can be forgotten. */
bool slc_forgetting_allows(const SluiceVulkanStreamer *s, const SluiceVulkanTextureCreateInfo *info,
                           const SluiceImageInfo *image);
/** Chooses residency and layout of such a texture. Makes no image. */
SluiceResult slc_forgetting_describe(SluiceVulkanStreamer *s, uint32_t index,
                                     SluiceResidencyMode mode, const SluiceImageInfo *image,
                                     struct slc_residency **residency,
                                     struct slc_residency_image *out);
/** Textures follow this one from now on: it is not forgotten any more. */
void slc_forgetting_keep(SluiceVulkanStreamer *s, uint32_t index);
/** The texture was removed. */
void slc_forgetting_drop(SluiceVulkanStreamer *s, uint32_t index);

/** The manager took in a map of the texture. */
void slc_forgetting_used(SluiceVulkanStreamer *s, uint32_t index);
/** Makes the image of a forgotten texture. False: not yet, or memory is short. */
bool slc_forgetting_wake(SluiceVulkanStreamer *s, uint32_t index);
/** Forgets what the frame that begins has to: after feedback, before anything is unmapped. */
SluiceResult slc_forgetting_step(SluiceVulkanStreamer *s);
/** Destroys images that no frame needs. Returns the largest retire value up to `limit` that none of
 *  the others holds back. */
uint64_t slc_forgetting_retire(SluiceVulkanStreamer *s, uint64_t limit);

#endif /* SLC_VULKAN_TEXTURE_FORGETTING_H */
