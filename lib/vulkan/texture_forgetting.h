/**
 * Forgetting of unsampled textures: image, views and tiles are destroyed. A record on the
 * host stays, with its regions of feedback. The texture is made again when feedback requests it.
 *
 *     PRESENT     has an image
 *     LEAVING     hidden from shaders from a frame on; the image waits for earlier frames
 *     FORGOTTEN   has no image
 *
 * docs/decisions/0077-streamers-forget-textures.md has the rules.
 */
#ifndef SLC_VULKAN_TEXTURE_FORGETTING_H
#define SLC_VULKAN_TEXTURE_FORGETTING_H

#include "vulkan/streamer.h"

/** True if a texture with this description can be forgotten. */
bool slc_forgetting_allows(const SluiceVulkanStreamer *s, const SluiceVulkanTextureCreateInfo *info,
                           const SluiceImageInfo *image);
/** Chooses residency and layout of a texture that can be forgotten. Makes no image. */
SluiceResult slc_forgetting_describe(SluiceVulkanStreamer *s, uint32_t index,
                                     SluiceResidencyMode mode, const SluiceImageInfo *image,
                                     struct slc_residency **residency,
                                     struct slc_residency_image *out);
/** Excludes a texture from forgetting, because other textures follow it. */
void slc_forgetting_keep(SluiceVulkanStreamer *s, uint32_t index);
/** Ends the bookkeeping of a texture that was removed. */
void slc_forgetting_drop(SluiceVulkanStreamer *s, uint32_t index);

/** Notes that the manager got a map of the texture. */
void slc_forgetting_used(SluiceVulkanStreamer *s, uint32_t index);
/** Makes the image of a forgotten texture. False: frames still use the old one, or memory is short.
 */
bool slc_forgetting_wake(SluiceVulkanStreamer *s, uint32_t index);
/** Forgets textures when a frame begins. Call it after feedback, and before tiles are unmapped. */
SluiceResult slc_forgetting_step(SluiceVulkanStreamer *s);
/** Destroys images that no frame needs. Returns the largest retire value up to `limit` that no
 *  remaining image holds back. */
uint64_t slc_forgetting_retire(SluiceVulkanStreamer *s, uint64_t limit);

#endif /* SLC_VULKAN_TEXTURE_FORGETTING_H */
