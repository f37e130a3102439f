/**
 * Reads regions of image sources on worker threads: urgent ones first, cancellable, never waiting
 * on the caller's thread. What fails for now is tried again, and a source that answers slowly or
 * not at all keeps only its share of the threads.
 */
#ifndef SLUICE_LOADER_H
#define SLUICE_LOADER_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceTileLoader SluiceTileLoader;

/**
 * When a read is tried again. IO, OUT_OF_HOST_MEMORY and NOT_READY pass, so up to maxAttempts are
 * made; CORRUPT_DATA is tried once more, because what is written while it is read looks damaged;
 * all other errors stay what they are. Regions that were delivered are not read again.
 */
typedef struct SluiceTileRetryPolicy {
    uint32_t maxAttempts; ///< 0: 4; 1: nothing is tried again
    uint64_t firstDelay;  ///< ns between the first attempt and the second, then doubled; 0: 10^7
    uint64_t maxDelay;    ///< ns, where doubling ends; 0: 10^9
} SluiceTileRetryPolicy;

/** An attempt at a read that failed. Pointers are valid during the call. */
typedef struct SluiceTileReadFailure {
    SluiceImageSource *source;
    const char *pName; ///< the source's, of an array the layer's; "" if it did not even tell that
    SluiceImageRegion region; ///< that failed
    SluiceResult result;
    uint32_t attempt; ///< from 1
    bool willRetry;   ///< after retryDelay; else the read ends with this result
    uint64_t retryDelay;
    uint64_t userValue; ///< the read's
    /** Where in the file, in bytes; SLUICE_UNKNOWN_OFFSET if the source does not say. */
    uint64_t offset;
} SluiceTileReadFailure;

/**
 * Told of every failure but CANCELLED, and of NOT_READY only where that is the end. Off when
 * `pfnFailed` is NULL. Called on worker threads, several at once; the source and the loader's
 * functions may be used, but for sluiceDestroyTileLoader and sluiceWaitTileLoaderIdle.
 */
typedef struct SluiceTileReadFailureCallback {
    void *pUserData;
    void (*pfnFailed)(void *pUserData, const SluiceTileReadFailure *pFailure);
} SluiceTileReadFailureCallback;

/**
 * Told of every read that has ended, with whatever result, and can be collected: for those who wait
 * instead of asking. Off when `pfnEnded` is NULL. Called on the thread that ended it, also in
 * sluiceCancelTileRead and sluiceDestroyTileLoader, with the loader locked: functions of the loader
 * may not be used, and other reads wait until it returns.
 */
typedef struct SluiceTileReadEndCallback {
    void *pUserData;
    void (*pfnEnded)(void *pUserData, uint64_t userValue, SluiceResult result);
} SluiceTileReadEndCallback;

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceTileLoaderCreateInfo {
    uint32_t threadCount;     ///< 0: one less than there are processors, at least 2
    uint32_t requestCapacity; ///< reads not yet collected, at most, up to 2^29; 0: 1024
    const SluiceAllocationCallbacks *pAllocator; ///< NULL: malloc and free
    SluiceTileRetryPolicy retry;
    /** Reads of one source that are under way at once: a source that stalls holds so many threads
     *  and no more. 0: threadCount - 1, at least 1. */
    uint32_t maxReadsPerSource;
    /** Bytes of texels of reads that are under way at once; a larger read waits until it is alone.
     *  0: 2^28. */
    uint64_t maxBytesInFlight;
    SluiceTileReadFailureCallback failure;
    /** Sources whose statistics are kept, about 700 bytes each; beyond it those longest without
     *  reads are forgotten. At most 2^29; at least requestCapacity; 0: that. */
    uint32_t maxSourceCount;
    SluiceTileReadEndCallback end;
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
    /** The source's to the last attempt, NOT_READY among them; CANCELLED if it was dropped before
     *  its last region or before another attempt. */
    SluiceResult result;
    uint64_t size; ///< bytes of texels delivered; 0 unless the result is SUCCESS
} SluiceTileReadResult;

/** Starts the threads. Errors: NULL_POINTER; INVALID_ARGUMENT for counts beyond their limits;
 *  OUT_OF_HOST_MEMORY, also for want of threads. */
SLUICE_API SluiceResult sluiceCreateTileLoader(const SluiceTileLoaderCreateInfo *pCreateInfo,
                                               SluiceTileLoader **pLoader);

/** Cancels what has not begun or waits for another attempt, waits for regions that are being read.
 *  NULL is allowed. */
SLUICE_API void sluiceDestroyTileLoader(SluiceTileLoader *loader);

/**
 * Queues a read. `*pTicket` is never 0 and never comes again. Returns SLUICE_NOT_READY, and queues
 * nothing, while requestCapacity reads are uncollected. Regions are checked when they are read.
 * Errors: NULL_POINTER, INVALID_ARGUMENT. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceSubmitTileRead(SluiceTileLoader *loader, const SluiceTileRead *pRead,
                                             uint64_t *pTicket);

/**
 * The same for `count` reads, all of them or, with NOT_READY or an error, none. Many reads are
 * queued so without the threads, which begin when they all are, getting in the way.
 */
SLUICE_API SluiceResult sluiceSubmitTileReads(SluiceTileLoader *loader, uint32_t count,
                                              const SluiceTileRead *pReads, uint64_t *pTickets);

/**
 * Asks for a read to be dropped. It is collected all the same: as CANCELLED if it had not begun,
 * had regions left or was to be tried again, otherwise as if nothing had been said. Unknown and
 * collected tickets are ignored. Thread safety: any thread.
 */
SLUICE_API void sluiceCancelTileRead(SluiceTileLoader *loader, uint64_t ticket);

/**
 * Collects finished reads in the order in which they finished; never waits. `*pResultCount` is the
 * room on entry, the number written on return; SLUICE_INCOMPLETE if more had finished.
 * Errors: NULL_POINTER. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCollectTileReads(SluiceTileLoader *loader, uint32_t *pResultCount,
                                               SluiceTileReadResult *pResults);

/** Waits until nothing is queued, being read or to be tried again. For tests and shutdown. Any
 *  thread. */
SLUICE_API void sluiceWaitTileLoaderIdle(SluiceTileLoader *loader);

/**
 * What became of the reads of a source, or of all. An attempt is one try at all regions of a read
 * that are left; a latency the ns that one took, failed ones included. Percentiles are upper
 * bounds, less than twice too large, up to 2^47 ns.
 */
typedef struct SluiceTileLoaderStatistics {
    uint64_t readCount;      ///< submitted; those not counted as ended below are under way
    uint64_t succeededCount; ///< ended with SUCCESS
    uint64_t givenUpCount;   ///< ended with an error or NOT_READY
    uint64_t cancelledCount; ///< ended with CANCELLED
    uint64_t byteCount;      ///< texels of those that succeeded
    uint64_t attemptCount;
    uint64_t failedCount;   ///< attempts that ended with an error but CANCELLED
    uint64_t notReadyCount; ///< attempts that ended with NOT_READY
    uint64_t retriedCount;  ///< attempts after which another was to be made
    uint64_t delayedCount;  ///< reads that wait for one now
    uint64_t meanLatency, medianLatency, latency99, maxLatency;
    /** Of the latest attempt that failedCount counts: its result, and where in the file it failed,
     *  or SLUICE_UNKNOWN_OFFSET; SUCCESS and 0 while there is none. */
    SluiceResult lastFailure;
    uint64_t lastFailureOffset;
} SluiceTileLoaderStatistics;

/**
 * `source` NULL: of all reads. Zeros for a source of which nothing was submitted, or that is
 * forgotten. Errors: NULL_POINTER. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetTileLoaderStatistics(SluiceTileLoader *loader,
                                                      const SluiceImageSource *source,
                                                      SluiceTileLoaderStatistics *pStatistics);

/**
 * Drops what the loader knows of a source. Useful where the source is destroyed: another one at the
 * same address would otherwise go on with its statistics. Returns
 * SLUICE_NOT_READY, with nothing changed, while reads of it are not collected. The statistics of
 * all reads stay. Errors: NULL_POINTER. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceForgetTileLoaderSource(SluiceTileLoader *loader,
                                                     const SluiceImageSource *source);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_LOADER_H */
