/**
 * Strict mode of a streamer (vulkan.h): reports misuse while an application is developed. Link
 * `sluice-vulkan`.
 *
 * docs/control.md explains the reports.
 *
 * Thread safety: external on the streamer, as all calls of vulkan.h.
 */
#ifndef SLUICE_VULKAN_STRICT_H
#define SLUICE_VULKAN_STRICT_H

#include <sluice/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A kind of misuse. */
typedef enum SluiceMisuseKind {
    SLUICE_MISUSE_FRAME_NOT_ENDED = 0,    ///< A frame is begun before the last one was ended.
    SLUICE_MISUSE_FRAME_NOT_BEGUN = 1,    ///< A frame is ended that was not begun.
    SLUICE_MISUSE_FRAME_NOT_SIGNALED = 2, ///< No begin is ready: an old frame is never signaled.
    SLUICE_MISUSE_NO_FEEDBACK = 3,        ///< No shader marks anything.
    SLUICE_MISUSE_HEAPS_EXHAUSTED = 4,    ///< Tiles wait, and no further heap can be had.
    SLUICE_MISUSE_CHUNKS_EXHAUSTED = 5,   ///< Tiles wait: all images of pages are in use.
    SLUICE_MISUSE_SOURCE_IN_USE = 6       ///< A source is destroyed that is in use.
} SluiceMisuseKind;

/** A report. Valid during the call. Never grows. */
typedef struct SluiceMisuse {
    SluiceMisuseKind kind;
    uint64_t value;       ///< Number of the frame, of frames, of heaps or of images; see pMessage.
    const char *pMessage; ///< Names the object, the value, and what to do.
} SluiceMisuse;

/** Settings of strict mode. A field of zero selects its default. */
typedef struct SluiceVulkanStrictMode {
    uint32_t structSize; ///< sizeof(SluiceVulkanStrictMode).
    /** Frames without any mark of a shader until NO_FEEDBACK is reported. Default: 600. */
    uint32_t framesWithoutFeedback;
    /** Calls of sluiceBeginStreamingFrame that are not ready, one after the other, until
     *  FRAME_NOT_SIGNALED is reported. Default: 1000. */
    uint32_t refusedBegins;
    /** Frames until HEAPS_EXHAUSTED and CHUNKS_EXHAUSTED may be reported again. Default: 600. */
    uint32_t repeatFrames;
    void *pUserData;
    /** Required. Called within calls of the streamer, on their thread. Must not call the streamer.
     */
    void (*pfnReport)(void *pUserData, const SluiceMisuse *pMisuse);
} SluiceVulkanStrictMode;

/**
 * Turns strict mode on, or off if `pMode` is NULL. Decisions are the same with and without it.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a wrong
 *         structSize or without pfnReport.
 */
SLUICE_API SluiceResult sluiceSetVulkanStrictMode(SluiceVulkanStreamer *streamer,
                                                  const SluiceVulkanStrictMode *pMode);

/**
 * Destroys an image source if the streamer does not use it (sluiceIsVulkanSourceInUse). Otherwise
 * returns SLUICE_NOT_READY, destroys nothing, and reports SLUICE_MISUSE_SOURCE_IN_USE in strict
 * mode. Other streamers and demand loaders are not asked.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceReleaseVulkanSource(SluiceVulkanStreamer *streamer,
                                                  SluiceImageSource *source);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_STRICT_H */
