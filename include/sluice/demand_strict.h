/**
 * Strict mode of a demand loader (demand.h): reports misuse while an application is developed. Link
 * `sluice-vulkan`.
 *
 * docs/demand.md explains the reports. vulkan_strict.h has the same for streamers.
 *
 * Thread safety: external on the loader.
 */
#ifndef SLUICE_DEMAND_STRICT_H
#define SLUICE_DEMAND_STRICT_H

#include <sluice/demand.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A kind of misuse. */
typedef enum SluiceDemandMisuseKind {
    SLUICE_DEMAND_MISUSE_LAUNCH_NOT_ENDED = 0, ///< A launch is begun before the last one was ended.
    SLUICE_DEMAND_MISUSE_LAUNCH_NOT_BEGUN = 1, ///< A launch is ended that was not begun.
    SLUICE_DEMAND_MISUSE_LAUNCH_NOT_SIGNALED = 2, ///< Calls wait for a launch without end.
    SLUICE_DEMAND_MISUSE_LAUNCH_NOT_PROCESSED =
        3,                                       ///< No begin is ready: launches are not processed.
    SLUICE_DEMAND_MISUSE_NO_REQUESTS = 4,        ///< No shader requests or uses anything.
    SLUICE_DEMAND_MISUSE_TILES_EXHAUSTED = 5,    ///< Tiles exceed memory: textures are coarser.
    SLUICE_DEMAND_MISUSE_PAGES_EXHAUSTED = 6,    ///< Pages of resources wait for memory.
    SLUICE_DEMAND_MISUSE_CHUNKS_EXHAUSTED = 7,   ///< Tiles wait: all images of pages are in use.
    SLUICE_DEMAND_MISUSE_TEXTURES_EXHAUSTED = 8, ///< A texture is added beyond maxTextureCount.
    SLUICE_DEMAND_MISUSE_IDS_EXHAUSTED = 9,      ///< A texture opens that finds no virtual pages.
    SLUICE_DEMAND_MISUSE_SOURCE_IN_USE = 10      ///< A source is destroyed that is in use.
} SluiceDemandMisuseKind;

/** A report. Valid during the call. Never grows. */
typedef struct SluiceDemandMisuse {
    SluiceDemandMisuseKind kind;
    uint64_t value; ///< Number of the launch, of launches, of tiles, of pages or of images; see
                    ///< pMessage.
    const char *pMessage; ///< Names the object, the value, and what to do.
} SluiceDemandMisuse;

/** Settings of strict mode. A field of zero selects its default. */
typedef struct SluiceDemandStrictMode {
    uint32_t structSize; ///< sizeof(SluiceDemandStrictMode).
    /** Launches in which no shader requests or uses any page until NO_REQUESTS is reported.
     *  Default: 600. */
    uint32_t launchesWithoutRequests;
    /** Nanoseconds for which calls wait for one launch, or return SLUICE_NOT_READY for it, until
     *  LAUNCH_NOT_SIGNALED or LAUNCH_NOT_PROCESSED is reported. Default: 5 s. */
    uint64_t unsignaledNs;
    /** Launches until TILES_EXHAUSTED, PAGES_EXHAUSTED, CHUNKS_EXHAUSTED and IDS_EXHAUSTED may be
     *  reported again. Default: 600. */
    uint32_t repeatLaunches;
    void *pUserData;
    /** Required. Called within calls of the loader, on their thread. Must not call the loader. */
    void (*pfnReport)(void *pUserData, const SluiceDemandMisuse *pMisuse);
} SluiceDemandStrictMode;

/**
 * Turns strict mode on, or off if `pMode` is NULL. Decisions are the same with and without it.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a wrong
 *         structSize or without pfnReport.
 */
SLUICE_API SluiceResult sluiceSetDemandStrictMode(SluiceDemandLoader *loader,
                                                  const SluiceDemandStrictMode *pMode);

/**
 * Says whether the loader uses an image source: a texture has it, or an image that pfnOpen opened
 * is this source and not yet closed. A source that pfnOpen is about to return does not count.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceIsDemandSourceInUse(const SluiceDemandLoader *loader,
                                                  const SluiceImageSource *source, bool *pInUse);

/**
 * Destroys an image source if the loader does not use it (sluiceIsDemandSourceInUse). Otherwise
 * returns SLUICE_NOT_READY, destroys nothing, and reports SLUICE_DEMAND_MISUSE_SOURCE_IN_USE in
 * strict mode. Other demand loaders and streamers are not asked.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceReleaseDemandSource(SluiceDemandLoader *loader,
                                                  SluiceImageSource *source);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DEMAND_STRICT_H */
