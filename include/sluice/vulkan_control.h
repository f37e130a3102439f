/**
 * Controls single textures of a streamer (vulkan.h). Link `sluice-vulkan`.
 *
 * docs/control.md explains the calls.
 *
 * Thread safety: external on the streamer, as all calls of vulkan.h.
 */
#ifndef SLUICE_VULKAN_CONTROL_H
#define SLUICE_VULKAN_CONTROL_H

#include <sluice/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Rectangle of a texture, in texels of level 0. All zero: the whole texture. Never grows. */
typedef struct SluiceTextureRect {
    uint32_t x, y, width, height;
} SluiceTextureRect;

/** What shaders see of a rectangle of a texture. */
typedef struct SluiceVulkanTextureState {
    uint32_t structSize; ///< sizeof(SluiceVulkanTextureState).
    bool drawable;       ///< Every sample in the rectangle shows texels of the texture.
    /**
     * Coarsest level that is resident somewhere in the rectangle: every sample may show this level.
     * SLUICE_MIP_UNTOUCHED if the rectangle is not drawable.
     */
    uint32_t residentLevel;
    /**
     * Coarsest level that shaders show in the rectangle. Above residentLevel, by a fraction, while
     * regions fade in (residencyFadeTicks). SLUICE_MIP_UNTOUCHED if it is not drawable.
     */
    float shownLevel;
} SluiceVulkanTextureState;

/**
 * Gets what shaders see of a texture, or of a rectangle of it, in the last frame begun.
 *
 * Whole tiles of level 0 count. Takes time in proportion to their number. `pRect` NULL: the whole
 * texture.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the rectangle leaves the texture or
 *         has one side of 0, or for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetVulkanTextureState(const SluiceVulkanStreamer *streamer,
                                                    SluiceTextureId textureId,
                                                    const SluiceTextureRect *pRect,
                                                    SluiceVulkanTextureState *pState);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_CONTROL_H */
