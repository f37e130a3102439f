/**
 * Threads, or jobs of the application, that read for several tile loaders.
 *
 * The loaders of a pool take turns, one read each, so that none of them starves. Limits of bytes
 * and of reads per source count the reads of all loaders together. Each loader has its own
 * capacity, results, retry policy, callbacks and statistics.
 */
#ifndef SLC_IMAGE_READ_POOL_H
#define SLC_IMAGE_READ_POOL_H

#include <sluice/loader.h>

#include "image/read_jobs.h"
#include "image/read_queue.h"
#include "platform/thread.h"

struct slc_read_pool {
    SluiceAllocationCallbacks allocator;
    struct slc_mutex mutex;    ///< around everything below, and all queues
    struct slc_condition work; ///< a read may have become startable or delayed, or the pool stops
    struct slc_condition idle; ///< nothing of some loader is queued, delayed or running
    struct slc_read_load load;
    SluiceTileLoader *loaders; ///< in a list
    SluiceTileLoader *turn;    ///< which starts the next read if it can
    bool stopping;
    uint32_t waiting_count;  ///< threads that wait for `work`
    uint32_t signaled_count; ///< of these, threads that were signaled and have not woken yet
    uint32_t thread_count;
    struct slc_thread *threads;
    struct slc_read_jobs jobs;       ///< in place of threads
    struct slc_shared_reads *shares; ///< of a SluiceReadPool; NULL: nothing is shared
};

struct SluiceTileLoader {
    SluiceAllocationCallbacks allocator;
    SluiceTileRetryPolicy retry;
    SluiceTileReadFailureCallback failure;
    SluiceTileReadEndCallback end;
    struct slc_read_pool *pool;
    bool owns_pool;
    SluiceReadPool *member_of; ///< a loader of the application
    bool ending;               ///< it is being destroyed
    bool awaited;              ///< its owner waits for a read to end
    bool uncached; ///< texels are read to the cache first: the host reads their memory slowly
    /** Interfaces of sources that are no images: their reads go straight to the memory that was
     *  given, which may have more bytes than the region. */
    const SluiceImageSourceInterface *direct[2];
    SluiceTileLoader *next;      ///< of the pool's loaders
    struct slc_read_queue queue; ///< the pool's mutex is around it
};

/**
 * Creates a pool and starts its threads. Uses pAllocator, threadCount, pJobSystem,
 * maxReadsPerSource and maxBytesInFlight of `info`.
 *
 * Errors: OUT_OF_HOST_MEMORY, also if a thread cannot be started.
 */
SluiceResult slc_read_pool_create(const SluiceTileLoaderCreateInfo *info,
                                  struct slc_read_pool **pool);
/** Stops the threads, or waits for all jobs. All loaders of the pool are destroyed. NULL is
 * allowed. */
void slc_read_pool_destroy(struct slc_read_pool *pool);

/**
 * Creates a loader whose reads the pool's threads do. Uses the other fields of `info`. Destroy the
 * loader with sluiceDestroyTileLoader, before the pool.
 *
 * Errors: INVALID_ARGUMENT, OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_create_pool_loader(struct slc_read_pool *pool,
                                    const SluiceTileLoaderCreateInfo *info,
                                    SluiceTileLoader **loader);

/** With the mutex held: reads may have become startable. Wakes a thread, or notes that a job is
 *  needed. */
void slc_read_pool_signal(struct slc_read_pool *pool);
/** Unlocks the mutex, after it has submitted the job that slc_read_pool_signal has noted. Allowed
 *  where the pool may be destroyed once the mutex is unlocked. */
void slc_read_pool_unlock(struct slc_read_pool *pool);
/** With the mutex held, which is given up meanwhile: reads once. False, at once, if nothing can be
 *  started. */
bool slc_read_pool_read(struct slc_read_pool *pool);
/** With the mutex held: waits on `idle` until slc_monotonic_time() is `until`, at the latest.
 *  UINT64_MAX: for ever. A pool with jobs may read meanwhile, on this thread. */
void slc_read_pool_wait(struct slc_read_pool *pool, uint64_t until);
/** With the mutex held: when the first delayed read is due. UINT64_MAX: none is delayed. */
uint64_t slc_read_pool_next_due(const struct slc_read_pool *pool);
/** With the mutex held: something can be started or waits for a retry. */
bool slc_read_pool_has_startable(const struct slc_read_pool *pool);
bool slc_read_pool_has_work(const struct slc_read_pool *pool);
/** With the mutex held: ends a read and tells the loader's owner. */
void slc_loader_end_read(SluiceTileLoader *loader, struct slc_read *read, SluiceResult result);
void slc_loader_signal_if_idle(SluiceTileLoader *loader);
/** Waits until a read can be collected, none is under way, or slc_monotonic_time() is `until`.
 *  Returns false in the last case. Without the mutex, on the thread that collects. */
bool slc_loader_wait_for_read(SluiceTileLoader *loader, uint64_t until);

/** Reads once if the pool has jobs, of which none runs. False if it does not read. Without the
 * mutex: for threads that wait for the end of a read by other means. */
bool slc_loader_help(SluiceTileLoader *loader);

/** End of one attempt at a read. */
struct slc_read_outcome {
    SluiceResult result;
    SluiceImageFault fault;
    uint32_t region;  ///< that failed
    uint64_t latency; ///< ns
};

/** Reads one region at once, into the read's memory. */
SluiceResult slc_loader_read_region(const SluiceTileLoader *loader, const struct slc_read *read,
                                    const SluiceImageInfo *info, uint32_t region,
                                    SluiceImageFault *fault);
/** Nobody wants the read any more. */
bool slc_read_is_dropped(const struct slc_read *read);
/** A region of the read is delivered. With the mutex held, or on the thread that has the read. */
void slc_read_region_done(struct slc_read *read, SluiceFormat format, uint32_t region);
/** With the mutex held, which is given up meanwhile: reports an attempt at a running read, and ends
 *  or delays the read. */
void slc_loader_settle_read(SluiceTileLoader *loader, struct slc_read *read,
                            const struct slc_read_outcome *outcome);

#endif /* SLC_IMAGE_READ_POOL_H */
