/**
 * Reads regions of image sources on worker threads, urgent ones first.
 *
 * Reads can be canceled. No call blocks the caller on a file. Temporary failures are retried. A
 * source that is slow or does not answer occupies only its share of the threads.
 */
#ifndef SLUICE_LOADER_H
#define SLUICE_LOADER_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceTileLoader SluiceTileLoader;

/**
 * Threads that read for several contexts or tile loaders, and each region once.
 *
 * Contexts of several devices (SluiceVulkanContextCreateInfo.readPool) and tile loaders
 * (SluiceTileLoaderCreateInfo.readPool) are the members of a pool. While a pool has two members or
 * more, a region of a source that one member is reading is not read again for another one: the
 * other read waits, without a thread, and copies the texels. Texels stay in host memory for members
 * that ask later. A pool with one member keeps nothing.
 *
 * Regions are equal if the address of the source, the array layer, the level and the rectangle are.
 * So give all devices the same SluiceImageSource. Sources that pfnOpen opens for each device are
 * read for each device.
 *
 * Texels of a source must not change while the pool keeps them. Streamers and demand loaders tell
 * the pool when you invalidate, replace or remove a texture. Tile loaders of the application tell
 * it by sluiceDropTileLoaderStatistics.
 */
typedef struct SluiceReadPool SluiceReadPool;

/**
 * How often and when a failed read is tried again.
 *
 * SLUICE_ERROR_IO, SLUICE_ERROR_OUT_OF_HOST_MEMORY and SLUICE_NOT_READY are temporary: up to
 * maxAttempts are made. SLUICE_ERROR_CORRUPT_DATA is retried once, because a file that is being
 * written looks damaged. Other errors are final. A retry skips regions that were already read.
 * Never grows.
 */
typedef struct SluiceTileRetryPolicy {
    uint32_t maxAttempts;  ///< Default: 4. 1: no retry.
    uint64_t firstDelayNs; ///< Ns from attempt 1 to 2; doubled each time. Default: 10^7.
    uint64_t maxDelayNs;   ///< Largest delay, in ns. Default: 10^9.
} SluiceTileRetryPolicy;

/** Failed attempt to read. Pointers are valid during the call. */
typedef struct SluiceTileReadFailure {
    uint32_t structSize; ///< Set by Sluice. sizeof(SluiceTileReadFailure).
    SluiceImageSource *source;
    const char *pName;        ///< Name of the source, or of the array's layer. "" if unknown.
    SluiceImageRegion region; ///< Region that failed.
    SluiceResult result;
    uint32_t attempt;      ///< Counts from 1.
    bool willRetry;        ///< False: the read ends with `result`.
    uint64_t retryDelayNs; ///< Ns until the next attempt.
    uint64_t userValue;    ///< SluiceTileRead.userValue.
    /** Byte offset in the file, or SLUICE_UNKNOWN_OFFSET. */
    uint64_t offset;
} SluiceTileReadFailure;

/**
 * Receives failed attempts. Off if `pfnFailed` is NULL.
 *
 * SLUICE_ERROR_CANCELED is not reported. SLUICE_NOT_READY is reported only if it ends the read.
 * Called on worker threads, several at the same time. The callback may use the source and the
 * loader, except sluiceDestroyTileLoader and sluiceWaitTileLoaderIdle. Never grows.
 */
typedef struct SluiceTileReadFailureCallback {
    void *pUserData;
    void (*pfnFailed)(void *pUserData, const SluiceTileReadFailure *pFailure);
} SluiceTileReadFailureCallback;

/**
 * Receives each read that has ended, with any result, and can be collected. For callers that wait
 * rather than poll. Off if `pfnEnded` is NULL.
 *
 * Called on the thread that ends the read; this includes callers of sluiceCancelTileRead and
 * sluiceDestroyTileLoader. The loader is locked, and so is its read pool: the callback must not
 * call the loader, nor its pool, nor any other loader or context of the pool. Other reads wait
 * until the callback returns. Never grows.
 */
typedef struct SluiceTileReadEndCallback {
    void *pUserData;
    void (*pfnEnded)(void *pUserData, uint64_t userValue, SluiceResult result);
} SluiceTileReadEndCallback;

/** Settings of a loader. A field of zero selects its default. */
typedef struct SluiceTileLoaderCreateInfo {
    uint32_t structSize;      ///< sizeof(SluiceTileLoaderCreateInfo).
    uint32_t threadCount;     ///< Default: processors - 1, at least 2.
    uint32_t requestCapacity; ///< Most uncollected reads. At most 2^29. Default: 1024.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceTileRetryPolicy retry;
    /** Most concurrent reads of one source, and so most threads that a stalled source occupies.
     *  Default: threadCount - 1, at least 1. */
    uint32_t maxReadsPerSource;
    /** Most bytes of texels being read at the same time. A single larger read waits until no other
     *  is running. Default: 2^28. */
    uint64_t maxBytesInFlight;
    SluiceTileReadFailureCallback failure;
    /** Sources whose statistics are kept, about 700 bytes each. The loader drops the statistics of
     *  the source that was least recently read. At most 2^29. Values below requestCapacity are
     *  raised to it. Default: requestCapacity. */
    uint32_t maxSourceCount;
    SluiceTileReadEndCallback end;
    /**
     * Reads in jobs of the application: the loader starts no threads. Copied. Default: none.
     *
     * threadCount is then the most jobs that read at the same time. A job reads once, submits its
     * successor if reads are left, and returns. A thread that waits for reads
     * (sluiceWaitTileLoaderIdle) reads itself while no job runs. A retry begins with the first call
     * of the loader, or end of a job, after its delay: collect reads now and then.
     *
     * sluiceDestroyTileLoader waits for all submitted jobs: run them on another thread.
     */
    const SluiceJobSystem *pJobSystem;
    /** Reads on the threads, or in the jobs, of a pool, with its limits: threadCount,
     *  maxReadsPerSource, maxBytesInFlight and pJobSystem must be 0. Must outlive the loader. A
     *  read that waits for an equal one of another loader fails with it: one attempt of both.
     *  Default: the loader has threads of its own. */
    SluiceReadPool *readPool;
} SluiceTileLoaderCreateInfo;

/** Default of SluiceReadPoolCreateInfo.cacheSize: 256 MiB. */
#define SLUICE_READ_POOL_DEFAULT_CACHE_SIZE ((uint64_t)1 << 28)

/** Settings of a read pool. A field of zero selects its default. */
typedef struct SluiceReadPoolCreateInfo {
    uint32_t structSize;  ///< sizeof(SluiceReadPoolCreateInfo).
    uint32_t threadCount; ///< At most 2^10. Default: processors - 1, at least 2.
    /** Most concurrent reads of one source, of all members together. Default: threadCount - 1, at
     *  least 1. */
    uint32_t maxReadsPerSource;
    /** Most bytes of texels being read at the same time, of all members together. A single larger
     *  read waits until no other is running. Default: 2^28. */
    uint64_t maxBytesInFlight;
    /** Reads in jobs of the application: the pool starts no threads. Copied. Default: none.
     *  SluiceTileLoaderCreateInfo.pJobSystem has the rules; sluiceDestroyReadPool waits for all
     *  submitted jobs. */
    const SluiceJobSystem *pJobSystem;
    const SluiceAllocationCallbacks *pAllocator; ///< Copied. Default: malloc and free.
    SluiceLogCallback log;                       ///< Refused calls.
    /**
     * Most bytes of texels that are kept after their read. The least recently used are dropped
     * first. Texels that are being read or copied are kept beyond this limit, at most
     * maxBytesInFlight and one tile for each waiting read. 1 keeps none longer. Memory is allocated
     * as texels are read. Default: SLUICE_READ_POOL_DEFAULT_CACHE_SIZE.
     */
    uint64_t cacheSize;
} SluiceReadPoolCreateInfo;

/**
 * Creates a pool and starts its threads, unless it has a job system.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also for a job system or an allocator without function;
 * SLUICE_ERROR_INVALID_ARGUMENT if threadCount is above its limit;
 * SLUICE_ERROR_OUT_OF_HOST_MEMORY, also if a thread cannot be started. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateReadPool(const SluiceReadPoolCreateInfo *pCreateInfo,
                                             SluiceReadPool **pPool);

/**
 * Destroys a pool. NULL is allowed.
 *
 * Destroy its contexts and tile loaders first. While one of them exists, this function logs an
 * error and does nothing; the pool stays valid, and can be destroyed later.
 *
 * Thread safety: external on `pool`.
 */
SLUICE_API void sluiceDestroyReadPool(SluiceReadPool *pool);

/**
 * Statistics of a read pool. Counts begin with its creation. A tile is one region; a mip tail has a
 * region for each level. Openings of images and fills of resources are not counted.
 */
typedef struct SluiceReadPoolStatistics {
    uint32_t structSize;       ///< sizeof(SluiceReadPoolStatistics).
    uint32_t memberCount;      ///< Contexts and tile loaders that use the pool now.
    uint64_t readCount;        ///< Regions that sources have delivered.
    uint64_t readSize;         ///< Their bytes.
    uint64_t joinedCount;      ///< Regions that waited for the read of another member, and copied.
    uint64_t cachedCount;      ///< Regions that were copied from texels kept earlier.
    uint64_t evictedCount;     ///< Regions dropped because of cacheSize.
    uint64_t invalidatedCount; ///< Regions dropped because texels changed or a user has gone.
    uint64_t refusedCount;     ///< Regions read without sharing, because memory was refused.
    uint64_t keptSize;         ///< Bytes of texels kept or being read now.
    uint64_t keptPeakSize;     ///< Largest keptSize.
    uint64_t keptCount;        ///< Regions kept or being read now.
} SluiceReadPoolStatistics;

/**
 * Gets the statistics of a pool.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetReadPoolStatistics(SluiceReadPool *pool,
                                                    SluiceReadPoolStatistics *pStatistics);

/**
 * One or more regions that are read together: one tile, or the mip tail of a texture. Never
 * grows.
 */
typedef struct SluiceTileRead {
    SluiceImageSource *source;         ///< Must live until the read is collected.
    uint32_t regionCount;              ///< 1 to SLUICE_MAX_READ_REGIONS.
    const SluiceImageRegion *pRegions; ///< Copied.
    /** Destination of each region, rows tightly packed. Must stay writable until collected. */
    void *const *ppTexels;
    uint32_t priority;  ///< Larger values are read first; equal ones in order of submission.
    uint64_t userValue; ///< Returned with the result.
} SluiceTileRead;

#define SLUICE_MAX_READ_REGIONS 24

/** Result of a read. Never grows. */
typedef struct SluiceTileReadResult {
    uint64_t ticket;
    uint64_t userValue;
    /** Result of the last attempt; may be SLUICE_NOT_READY. SLUICE_ERROR_CANCELED if the read was
     *  canceled before its last region, or while waiting for a retry. */
    SluiceResult result;
    uint64_t size; ///< Bytes of texels read. 0 unless `result` is SLUICE_SUCCESS.
} SluiceTileReadResult;

/**
 * Creates a loader and starts its threads, unless it has a job system or a read pool.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also for a job system without function;
 * SLUICE_ERROR_INVALID_ARGUMENT if a count is above its limit, or if a setting of the read pool is
 * given with one; SLUICE_ERROR_OUT_OF_HOST_MEMORY, also if a thread cannot be started. Thread
 * safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateTileLoader(const SluiceTileLoaderCreateInfo *pCreateInfo,
                                               SluiceTileLoader **pLoader);

/**
 * Destroys a loader. Cancels reads that have not begun or wait for a retry, and waits for regions
 * that are being read. NULL is allowed.
 * Thread safety: external on `loader`.
 */
SLUICE_API void sluiceDestroyTileLoader(SluiceTileLoader *loader);

/**
 * Queues one read. `*pTicket` is never 0 and never reused.
 *
 * Returns SLUICE_NOT_READY, with nothing queued, while requestCapacity reads are uncollected.
 * Regions are checked later, when they are read.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_INVALID_ARGUMENT.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceSubmitTileRead(SluiceTileLoader *loader, const SluiceTileRead *pRead,
                                             uint64_t *pTicket);

/**
 * Queues `count` reads under one lock. Workers start after the last read is queued.
 *
 * After SLUICE_NOT_READY or an error none of them is queued. Results and thread safety: as
 * sluiceSubmitTileRead.
 */
SLUICE_API SluiceResult sluiceSubmitTileReads(SluiceTileLoader *loader, uint32_t count,
                                              const SluiceTileRead *pReads, uint64_t *pTickets);

/**
 * Asks for a read to be canceled. The read must still be collected.
 *
 * Its result is SLUICE_ERROR_CANCELED if it had not begun, had regions left or waited for a retry;
 * otherwise the cancel has no effect. Unknown and collected tickets are ignored.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCancelTileRead(SluiceTileLoader *loader, uint64_t ticket);

/**
 * Collects finished reads in the order in which they finished. Never waits.
 *
 * `*pResultCount` is the capacity of `pResults` on entry and the number written on return. Returns
 * SLUICE_INCOMPLETE if more reads have finished.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCollectTileReads(SluiceTileLoader *loader, uint32_t *pResultCount,
                                               SluiceTileReadResult *pResults);

/**
 * Waits until no read is queued, running or waiting for a retry. For tests and shutdown.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceWaitTileLoaderIdle(SluiceTileLoader *loader);

/**
 * Statistics of the reads of one source, or of all reads.
 *
 * An attempt is one try at all remaining regions of a read. Latencies are nanoseconds per attempt,
 * failed attempts included. Percentiles are upper bounds, less than twice the true value, up to
 * 2^47 ns.
 */
typedef struct SluiceTileLoaderStatistics {
    uint32_t structSize;     ///< sizeof(SluiceTileLoaderStatistics).
    uint64_t readCount;      ///< Reads submitted. Open reads are in none of the next three counts.
    uint64_t succeededCount; ///< Ended with SLUICE_SUCCESS.
    uint64_t givenUpCount;   ///< Ended with an error or SLUICE_NOT_READY.
    uint64_t canceledCount;  ///< Ended with SLUICE_ERROR_CANCELED.
    uint64_t byteCount;      ///< Bytes of texels of reads that succeeded.
    uint64_t attemptCount;
    uint64_t failedCount;   ///< Attempts that failed, except by SLUICE_ERROR_CANCELED.
    uint64_t notReadyCount; ///< Attempts that returned SLUICE_NOT_READY.
    uint64_t retriedCount;  ///< Attempts that were followed by a retry.
    uint64_t delayedCount;  ///< Reads that wait for a retry now.
    uint64_t meanLatencyNs, medianLatencyNs, latency99Ns, maxLatencyNs;
    /** Result and byte offset (or SLUICE_UNKNOWN_OFFSET) of the latest attempt in failedCount.
     *  SLUICE_SUCCESS and 0 while there is none. */
    SluiceResult lastFailure;
    uint64_t lastFailureOffset;
} SluiceTileLoaderStatistics;

/**
 * Gets the statistics of `source`, or of all reads if `source` is NULL.
 *
 * Zeros if no read of the source was submitted, or if its statistics were dropped.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetTileLoaderStatistics(SluiceTileLoader *loader,
                                                      const SluiceImageSource *source,
                                                      SluiceTileLoaderStatistics *pStatistics);

/**
 * Drops the statistics of a source, and the texels that a read pool keeps of it. Call it when the
 * source is destroyed; otherwise a new source at the same address continues the statistics, and
 * reads of it may get old texels. Call it, too, when texels of the source have changed. Statistics
 * of all reads are kept.
 *
 * Returns SLUICE_NOT_READY, with no statistics dropped, while reads of the source are uncollected.
 * Texels are dropped nevertheless: reads that begin after this call read the source.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceDropTileLoaderStatistics(SluiceTileLoader *loader,
                                                       const SluiceImageSource *source);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_LOADER_H */
