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

/**
 * Writes the feedback of a texture as it was read back last: feedbackHeight rows of feedbackWidth
 * bytes (SluiceStreamedTextureLayout), `rowPitch` bytes apart.
 *
 * A byte stands for a region. It is the finest level that shaders marked there between the last two
 * turns of the texture, before limits, biases and requests of the application.
 * SLUICE_MIP_UNTOUCHED: no mark. All are untouched before the first turn. Textures that are hidden
 * or follow a primary texture have no turns, and keep the levels of their last one. For debugging
 * views; sluiceWriteRequestedLevels (manager.h) has what the manager makes of it.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_SIZE_MISMATCH if `rowPitch` < feedbackWidth or `size`, in bytes, is below
 *         (feedbackHeight - 1) * rowPitch + feedbackWidth.
 */
SLUICE_API SluiceResult sluiceWriteVulkanFeedback(const SluiceVulkanStreamer *streamer,
                                                  SluiceTextureId textureId, size_t rowPitch,
                                                  size_t size, uint8_t *pLevels);

/** Stages of a tile's way from a mark of a shader to the picture. */
typedef enum SluiceLoadStage {
    /** From the frame that reads a feedback map back to the frame whose begin takes it in. The turn
     * that a mark waits for comes before. */
    SLUICE_LOAD_STAGE_FEEDBACK = 0,
    SLUICE_LOAD_STAGE_QUEUE = 1, ///< From a tile's request until a frame takes it up.
    SLUICE_LOAD_STAGE_READ = 2,  ///< Until its texels are in staging memory.
    SLUICE_LOAD_STAGE_BIND = 3,  ///< Until it is bound, or has a page, and its copy is recorded.
    SLUICE_LOAD_STAGE_COPY = 4   ///< Until the frame that copies it is complete.
} SluiceLoadStage;

#define SLUICE_LOAD_STAGE_COUNT 5
#define SLUICE_STAGE_BUCKET_COUNT 12

/** Histogram of the frames that a stage takes. Never grows. */
typedef struct SluiceLoadStageCounts {
    uint64_t count;    ///< Maps or loads that left the stage. A mip tail can be several loads.
    uint64_t frameSum; ///< frameSum / count is the mean.
    uint64_t frameMax;
    /** [0]: in the frame that began it. [i]: 2^(i-1) to 2^i - 1 frames later. The last: or more. */
    uint64_t buckets[SLUICE_STAGE_BUCKET_COUNT];
} SluiceLoadStageCounts;

/** Histograms of the stages, since creation. */
typedef struct SluiceVulkanLoadStages {
    uint32_t structSize;                                   ///< sizeof(SluiceVulkanLoadStages).
    SluiceLoadStageCounts stages[SLUICE_LOAD_STAGE_COUNT]; ///< By SluiceLoadStage.
    /** From a tile's request until the frame that copies it is complete: the stages behind
     * feedback, and waits between them, for memory or pages. Prefetched tiles are not counted. */
    SluiceLoadStageCounts whole;
} SluiceVulkanLoadStages;

/**
 * Gets how many frames the stages of loads take, in constant time. Tiles of producers, tiles that
 * were restored or shared, canceled and failed loads leave no stage after the queue. A wait of more
 * than 1023 frames in the queue counts as 1023.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a wrong
 *         structSize.
 */
SLUICE_API SluiceResult sluiceGetVulkanLoadStages(const SluiceVulkanStreamer *streamer,
                                                  SluiceVulkanLoadStages *pStages);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_EXPLAIN_H */
