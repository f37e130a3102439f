/**
 * Says why a texture of a streamer (vulkan.h) is as coarse as it is. Link `sluice-vulkan`.
 *
 * docs/control.md explains the calls.
 *
 * Thread safety: external on the streamer, as all calls of vulkan.h.
 */
#ifndef SLUICE_VULKAN_EXPLAIN_H
#define SLUICE_VULKAN_EXPLAIN_H

#include <sluice/vulkan_control.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Why shaders show no finer level. */
typedef enum SluiceCoarseReason {
    SLUICE_COARSE_FINEST = 0,    ///< The source has no finer level.
    SLUICE_COARSE_ENOUGH = 1,    ///< Feedback and requests ask for no finer level.
    SLUICE_COARSE_NOT_SEEN = 2,  ///< Feedback has requested nothing there, or no longer does.
    SLUICE_COARSE_HIDDEN = 3,    ///< The application has hidden the texture (vulkan_control.h).
    SLUICE_COARSE_LIMIT = 4,     ///< finestLevel of SluiceVulkanTextureControl.
    SLUICE_COARSE_MIP_BIAS = 5,  ///< mipBias of SluiceVulkanTextureControl.
    SLUICE_COARSE_QUEUED = 6,    ///< Requested. Others are loaded first (tilesPerFrame).
    SLUICE_COARSE_BANDWIDTH = 7, ///< Requested. All maxLoadsInFlight loads are under way.
    SLUICE_COARSE_READING = 8,   ///< Its source or its producer is at work.
    SLUICE_COARSE_UPLOADING = 9, ///< It was read. The next frames bind, copy and publish it.
    SLUICE_COARSE_FADING = 10,   ///< It is resident, and fades in (residencyFadeTicks).
    /** No memory: no slot, page or image, the global mip bias, or the device's limit of tiles. */
    SLUICE_COARSE_BUDGET = 11,
    SLUICE_COARSE_FAILED = 12 ///< Loading it failed. It is tried again later.
} SluiceCoarseReason;

/** Bytes of a sentence, with the 0 at its end. */
#define SLUICE_EXPLANATION_SIZE 256

/** Why a rectangle of a texture is as coarse as it is. */
typedef struct SluiceVulkanExplanation {
    uint32_t structSize; ///< sizeof(SluiceVulkanExplanation).
    SluiceCoarseReason reason;
    /** Tile of level 0 that the answer is about: the coarsest one of which finer tiles are
     *  requested; if there is none, the coarsest. In texels. */
    SluiceTextureRect rect;
    uint32_t residentLevel; ///< Level that is resident there. SLUICE_MIP_UNTOUCHED: none.
    /** Finest level that is requested there, before limits and biases. SLUICE_MIP_UNTOUCHED: none.
     */
    uint32_t requestedLevel;
    /** Level of the tile that is missing. SLUICE_MIP_UNTOUCHED: nothing that counts is missing. */
    uint32_t missingLevel;
    char sentence[SLUICE_EXPLANATION_SIZE]; ///< The answer in English, with names and numbers.
} SluiceVulkanExplanation;

/**
 * Explains why a texture, or a rectangle of it, is as coarse as it is, as of the last frame begun.
 *
 * Whole tiles of level 0 count. Takes time in proportion to their number and to the texture's
 * requests of the application. `pRect` NULL: the whole texture.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the rectangle leaves the texture or
 *         has one side of 0, or for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceExplainVulkanTexture(const SluiceVulkanStreamer *streamer,
                                                   SluiceTextureId textureId,
                                                   const SluiceTextureRect *pRect,
                                                   SluiceVulkanExplanation *pExplanation);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_EXPLAIN_H */
