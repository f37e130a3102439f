/**
 * Reads regions of image sources on worker threads: urgent ones first, cancellable, never waiting
 * on the caller's thread.
 */
#ifndef SLUICE_LOADER_H
#define SLUICE_LOADER_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceTileLoader SluiceTileLoader;

typedef struct SluiceTileLoaderCreateInfo {
    uint32_t threadCount;     ///< 0: one less than there are processors, at least 1
    uint32_t requestCapacity; ///< reads not yet collected, at most; 0: 1024
    const SluiceAllocationCallbacks *pAllocator; ///< NULL: malloc and free
} SluiceTileLoaderCreateInfo;

/** One or more regions that are read as one: the packed levels of a texture, or one tile. */
typedef struct SluiceTileRead {
    SluiceImageSource *source;         ///< must live until the read is collected
    uint32_t regionCount;              ///< 1 to SLUICE_MAX_READ_REGIONS
    const SluiceImageRegion *pRegions; ///< copied
    /** Where each region goes, tightly packed rows; must stay writable until collected. */
    void *const *ppTexels;
    uint32_t priority;  ///< larger is read first; equal ones in the order of submission
    uint64_t userValue; ///< comes back with the result
} SluiceTileRead;

#define SLUICE_MAX_READ_REGIONS 24

typedef struct SluiceTileReadResult {
    uint64_t ticket;
    uint64_t userValue;
    /** The source's, NOT_READY among them; CANCELLED if it was dropped before its last region. */
    SluiceResult result;
    uint64_t size; ///< bytes of texels delivered; 0 unless the result is SUCCESS
} SluiceTileReadResult;

/** Starts the threads. Errors: NULL_POINTER; OUT_OF_HOST_MEMORY, also for want of threads. */
SLUICE_API SluiceResult sluiceCreateTileLoader(const SluiceTileLoaderCreateInfo *pCreateInfo,
                                               SluiceTileLoader **pLoader);

/** Cancels what has not begun, waits for regions that are being read. NULL is allowed. */
SLUICE_API void sluiceDestroyTileLoader(SluiceTileLoader *loader);

/**
 * Queues a read. `*pTicket` is never 0 and never comes again. Returns SLUICE_NOT_READY, and queues
 * nothing, while requestCapacity reads are uncollected. Regions are checked when they are read.
 * Errors: NULL_POINTER, INVALID_ARGUMENT. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceSubmitTileRead(SluiceTileLoader *loader, const SluiceTileRead *pRead,
                                             uint64_t *pTicket);

/**
 * Asks for a read to be dropped. It is collected all the same: as CANCELLED if it had not begun or
 * had regions left, otherwise as if nothing had been said. Unknown and collected tickets are
 * ignored. Thread safety: any thread.
 */
SLUICE_API void sluiceCancelTileRead(SluiceTileLoader *loader, uint64_t ticket);

/**
 * Collects finished reads in the order in which they finished; never waits. `*pResultCount` is the
 * room on entry, the number written on return; SLUICE_INCOMPLETE if more had finished.
 * Errors: NULL_POINTER. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCollectTileReads(SluiceTileLoader *loader, uint32_t *pResultCount,
                                               SluiceTileReadResult *pResults);

/** Waits until nothing is queued or being read. For tests and shutdown. Any thread. */
SLUICE_API void sluiceWaitTileLoaderIdle(SluiceTileLoader *loader);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_LOADER_H */
