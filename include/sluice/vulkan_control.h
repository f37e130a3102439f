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

/** State of a rectangle of a texture, as shaders see it. */
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
    /**
     * Resident tiles of the whole texture that still show texels from before
     * sluiceInvalidateVulkanTexture or sluiceReplaceVulkanSource. A mip tail counts as one.
     */
    uint32_t reloadingTileCount;
} SluiceVulkanTextureState;

/**
 * Gets the levels of a texture, or of a rectangle of it, that shaders can sample in the last frame
 * begun.
 *
 * A rectangle counts as the tiles of level 0 that it touches. Takes time in proportion to their
 * number. `pRect` NULL: the whole texture.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the rectangle leaves the texture or
 *         has one side of 0, or for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetVulkanTextureState(const SluiceVulkanStreamer *streamer,
                                                    SluiceTextureId textureId,
                                                    const SluiceTextureRect *pRect,
                                                    SluiceVulkanTextureState *pState);

/** Id of a request. Never 0 and never reused. */
typedef uint64_t SluiceTextureRequestId;

/** Request of the application for tiles of a texture. */
typedef struct SluiceVulkanTextureRequest {
    uint32_t structSize; ///< sizeof(SluiceVulkanTextureRequest).
    /** Finest level to load. Coarser levels come with it. Above the last level: packed levels. */
    uint32_t level;
    SluiceTextureRect rect; ///< Default: the whole texture.
    /**
     * Time stamp of the first frame in which the request is over, less than 2^63 after the present
     * one. UINT64_MAX: it lasts until it is withdrawn or the texture is removed (a pin). Default:
     * 0, over at once.
     */
    uint64_t until;
} SluiceVulkanTextureRequest;

/**
 * Requests tiles of a texture, as if every frame sampled the rectangle at `level`.
 *
 * The next frame begun starts to load the tiles that are not resident. In each region the finer of
 * feedback and requests counts. Like feedback, requests are made coarser while more tiles are
 * wanted than memory holds, and they expire feedbackTimeoutTicks after they are over. Followers of
 * the texture load the requested levels, too. Recordings hold requests as part of feedback maps.
 *
 * `pRequestId` may be NULL if you do not want to withdraw the request or see its progress.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the rectangle leaves the texture,
 *         if the texture follows another one (request its primary), or for a wrong structSize;
 *         SLUICE_ERROR_LIMIT_EXCEEDED for more than 2^20 requests that are not over;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. Nothing has changed after an error.
 */
SLUICE_API SluiceResult sluiceRequestVulkanTexture(SluiceVulkanStreamer *streamer,
                                                   SluiceTextureId textureId,
                                                   const SluiceVulkanTextureRequest *pRequest,
                                                   SluiceTextureRequestId *pRequestId);

/**
 * Withdraws a request: it is over. Does nothing if it was over before.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for an id
 *         that no request had.
 */
SLUICE_API SluiceResult sluiceWithdrawVulkanRequest(SluiceVulkanStreamer *streamer,
                                                    SluiceTextureRequestId requestId);

/** Progress of a request. */
typedef struct SluiceVulkanRequestProgress {
    uint32_t structSize; ///< sizeof(SluiceVulkanRequestProgress).
    bool over;           ///< It is over. All other fields are then 0.
    bool ready;          ///< Every sample of the rectangle can show its level.
    uint32_t tileCount;  ///< Tiles that it requests, of all levels, packed ones included.
    uint32_t residentTileCount;
    uint32_t givenUpTileCount; ///< Tiles whose loads failed too often (manager.h).
} SluiceVulkanRequestProgress;

/**
 * Gets how far a request is, in the last frame begun. Takes time in proportion to its tiles.
 *
 * It never becomes ready while given-up tiles fail, or while memory is short. Stop waiting when
 * residentTileCount + givenUpTileCount == tileCount.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for an id
 *         that no request had, or for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetVulkanRequestProgress(const SluiceVulkanStreamer *streamer,
                                                       SluiceTextureRequestId requestId,
                                                       SluiceVulkanRequestProgress *pProgress);

/** Why sluiceWaitVulkanRequest returned. */
typedef enum SluiceVulkanWaitStatus {
    SLUICE_VULKAN_WAIT_READY = 0,  ///< Every sample of the rectangle can show its level.
    SLUICE_VULKAN_WAIT_FAILED = 1, ///< Some tiles were given up, all others are resident.
    SLUICE_VULKAN_WAIT_OVER = 2,   ///< The request is over.
    /** The next step is a frame: begin, end and submit one, and wait again. */
    SLUICE_VULKAN_WAIT_FRAME = 3,
    SLUICE_VULKAN_WAIT_TIMEOUT = 4 ///< Reads are still under way, and a frame has nothing to do.
} SluiceVulkanWaitStatus;

/**
 * Waits for a request, at most `timeoutNanoseconds`: for loading screens. 0: returns its status.
 *
 * Frames give requests to the manager, take what was read, bind and copy it. So this function
 * returns SLUICE_VULKAN_WAIT_FRAME at once when a frame has something to do, and sleeps only while
 * only reads are in progress. While memory is short, SLUICE_VULKAN_WAIT_FRAME may be returned
 * without end: use a time limit. Threads of the context read meanwhile. On a thread of the
 * application that runs reads, pass 0.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for an id
 *         that no request had.
 */
SLUICE_API SluiceResult sluiceWaitVulkanRequest(SluiceVulkanStreamer *streamer,
                                                SluiceTextureRequestId requestId,
                                                uint64_t timeoutNanoseconds,
                                                SluiceVulkanWaitStatus *pStatus);

/** Limits, bias and visibility of a texture and of its followers. All zero: no limit, no bias,
 *  visible. */
typedef struct SluiceVulkanTextureControl {
    uint32_t structSize; ///< sizeof(SluiceVulkanTextureControl).
    /** Finest level to load, for all feedback and requests. Above the last level: only packed
     * levels are loaded. */
    uint32_t finestLevel;
    /** Levels added to what feedback requests, not to requests of the application. -32 to 32. */
    int32_t mipBias;
    /**
     * The texture cannot be in view. Its feedback is not read back: it leaves its turn to others.
     * Requests of its feedback are dropped, and its tiles stay as standby tiles until others need
     * the memory. Requests of the application still count. Set it back before the texture may be in
     * view again: its first map then restores what is still resident.
     */
    bool hidden;
    /** Order among textures if memory is too small for a level of all: highest first. See
     *  sluiceSetTexturePriority (manager.h). -SLUICE_MAX_PRIORITY to SLUICE_MAX_PRIORITY. */
    int32_t priority;
} SluiceVulkanTextureControl;

/**
 * Gets the control of a texture as it was last set. Set structSize first.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the texture follows another one, or
 *         for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetVulkanTextureControl(const SluiceVulkanStreamer *streamer,
                                                      SluiceTextureId textureId,
                                                      SluiceVulkanTextureControl *pControl);

/**
 * Sets the control of a texture. Takes effect when the next frame begins. Tiles finer than a new
 * limit become standby tiles at once. Recordings hold the effect as feedback maps and evictions.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a mipBias out of range, if the
 *         texture follows another one (control its primary), or for a wrong structSize;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. Nothing has changed after an error.
 */
SLUICE_API SluiceResult sluiceSetVulkanTextureControl(SluiceVulkanStreamer *streamer,
                                                      SluiceTextureId textureId,
                                                      const SluiceVulkanTextureControl *pControl);

/**
 * Evicts tiles of a texture and of its followers: drops the requests of feedback, and evicts
 * standby tiles until at most `keepTileCount` are left of each texture, finer levels first. The
 * next frame unmaps them. UINT32_MAX: keep all as standby tiles.
 *
 * Packed levels stay, unless packedLevelsOnDemand is set. If the texture is still in view, or
 * requests of the application count, its tiles are loaded again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE.
 */
SLUICE_API SluiceResult sluiceEvictVulkanTexture(SluiceVulkanStreamer *streamer,
                                                 SluiceTextureId textureId, uint32_t keepTileCount);

/**
 * Changes the primary of a texture: from now on it loads what the feedback of the primary requests.
 * SLUICE_NO_TEXTURE: its own feedback counts from now on. Does nothing if it is its primary.
 *
 * A texture that begins to follow another one loses its requests and its control. Neither it nor
 * its primary is forgotten from then on (forgetTextures). Requests of earlier maps expire as usual.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the primary is the texture itself
 *         or follows another one, or if the texture has followers. Nothing has changed after an
 *         error.
 */
SLUICE_API SluiceResult sluiceSetVulkanPrimaryTexture(SluiceVulkanStreamer *streamer,
                                                      SluiceTextureId textureId,
                                                      SluiceTextureId primaryId);

/**
 * Sets where a texture is sampled while it follows a primary: at UV * scale + offset, where UV is
 * the primary's. A detail map that repeats 8 times has scales of 8; KHR_texture_transform without
 * rotation has the same numbers. The wraps of `pTransform` are ignored: the texture's address modes
 * count. NULL: it is sampled where its primary is. sluiceSetUvTransform (manager.h) has the rules.
 *
 * The next frame begun gives the map of the primary to the texture. Only its loads change: shaders
 * sample it with their own UVs, and must not write its feedback.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a value out of range or a cube
 *         map; SLUICE_ERROR_OUT_OF_HOST_MEMORY. Nothing has changed after an error.
 */
SLUICE_API SluiceResult sluiceSetVulkanUvTransform(SluiceVulkanStreamer *streamer,
                                                   SluiceTextureId textureId,
                                                   const SluiceUvTransform *pTransform);

/**
 * Reads tiles again whose texels have changed in the source (hot reload).
 *
 * `pRegion` is a rectangle of a level; its array layer is ignored. NULL: all texels of level 0.
 * `mipLevelCount` levels from that level on have changed: 1 for that level alone, UINT32_MAX for
 * all coarser ones, which change where the rectangle covers them. A mip tail is read as a whole.
 *
 * The next frames read resident tiles again, a quarter of maxLoadsInFlight at a time, and copy the
 * texels over the old ones. Frames show the old texels until then. Reads under way are not used:
 * they begin again. Tiles that are not resident are read when they are requested. If a read fails,
 * the old texels stay, and the tile is read again retryDelayTicks later. All tiles of the texture
 * whose loads failed are tried again at once, also GIVEN_UP ones.
 *
 * Only this texture changes: call the function for each texture of a set, or of the source, whose
 * texels have changed. The source must deliver the new texels by now, and must not identify them
 * with the old ones (pfnIdentifyRegion).
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a rectangle that leaves its level
 *         or a texture with a producer; SLUICE_ERROR_OUT_OF_HOST_MEMORY. Nothing has changed after
 *         an error.
 */
SLUICE_API SluiceResult sluiceInvalidateVulkanTexture(SluiceVulkanStreamer *streamer,
                                                      SluiceTextureId textureId,
                                                      const SluiceImageRegion *pRegion,
                                                      uint32_t mipLevelCount);

/**
 * Replaces the source of a texture, and of all layers of its array, and reads all resident tiles
 * again as sluiceInvalidateVulkanTexture does. Image, views, indices and settings stay.
 *
 * The new source must outlive the texture. Destroy the old one when sluiceIsVulkanSourceInUse says
 * that nothing uses it: reads under way go on for some frames.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNKNOWN_TEXTURE; SLUICE_ERROR_STALE_TEXTURE;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if size, format, levels or layers
 *         differ (remove the texture and add a new one), or for a texture with a producer;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; errors of the source. Nothing has changed after an
 *         error.
 */
SLUICE_API SluiceResult sluiceReplaceVulkanSource(SluiceVulkanStreamer *streamer,
                                                  SluiceTextureId textureId,
                                                  SluiceImageSource *source);

/**
 * Gets whether a texture has the source, or a read of it is under way. Frames end reads, and so do
 * sluiceWaitVulkanStreamerIdle and sluiceDestroyVulkanStreamer.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceIsVulkanSourceInUse(const SluiceVulkanStreamer *streamer,
                                                  const SluiceImageSource *source, bool *pInUse);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_CONTROL_H */
