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
    struct slc_mutex mutex;    ///< guards everything below, and all queues
    struct slc_condition work; ///< a read may be startable or delayed, or the pool stops
    struct slc_condition idle; ///< some loader has no queued, delayed or running read any more
    struct slc_read_load load;
    SluiceTileLoader *loaders; ///< list of loaders
    SluiceTileLoader *turn;    ///< loader that starts the next read if it can
    bool stopping;
    uint32_t waiting_count;  ///< threads that wait for `work`
    uint32_t signaled_count; ///< waiting threads that were signaled and have not woken yet
    uint32_t thread_count;
    struct slc_thread *threads;
    struct slc_read_jobs jobs;       ///< in place of threads
    struct slc_shared_reads *shares; ///< shared regions of a SluiceReadPool; NULL: none
};

struct SluiceTileLoader {
    SluiceAllocationCallbacks allocator;
    SluiceTileRetryPolicy retry;
    SluiceTileReadFailureCallback failure;
    SluiceTileReadEndCallback end;
    struct slc_read_pool *pool;
    bool owns_pool;
    SluiceReadPool *member_of; ///< loaders of the application: their pool
    bool ending;               ///< the loader is being destroyed
    bool awaited;              ///< the owner waits for a read to end
    bool uncached; ///< the host reads texel memory slowly, so texels are read to the cache first
    /** Interfaces of sources that are no images. Their reads write directly to the given memory,
     * which may have more bytes than the region. */
    const SluiceImageSourceInterface *direct[2];
    SluiceTileLoader *next;      ///< next loader of the pool
    struct slc_read_queue queue; ///< guarded by the pool's mutex
};

/**
 * Creates a pool and starts its threads. Uses pAllocator, threadCount, pJobSystem,
 * maxReadsPerSource and maxBytesInFlight of `info`.
 *
 * Errors: OUT_OF_HOST_MEMORY, also if a thread cannot be started.
 */
SluiceResult slc_read_pool_create(const SluiceTileLoaderCreateInfo *info,
                                  struct slc_read_pool **pool);
/** Stops the threads, or waits for all jobs. Destroy all loaders of the pool first. NULL is
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

/** Wakes a thread, or notes that a job is needed, because reads may be startable. With the mutex
 *  held. */
void slc_read_pool_signal(struct slc_read_pool *pool);
/** Unlocks the mutex, after it has submitted the job that slc_read_pool_signal has noted. Allowed
 *  where the pool may be destroyed once the mutex is unlocked. */
void slc_read_pool_unlock(struct slc_read_pool *pool);
/** Reads once, with the mutex held, which is released in between. False, at once, if no read can be
 *  started. */
bool slc_read_pool_read(struct slc_read_pool *pool);
/** Waits on `idle`, with the mutex held, at most until slc_monotonic_time() is `until`. UINT64_MAX:
 *  forever. A pool with jobs may read meanwhile, on this thread. */
void slc_read_pool_wait(struct slc_read_pool *pool, uint64_t until);
/** Returns when the first delayed read is due, with the mutex held. UINT64_MAX: none is delayed. */
uint64_t slc_read_pool_next_due(const struct slc_read_pool *pool);
/** True if a read can be started or waits for a retry. With the mutex held. */
bool slc_read_pool_has_startable(const struct slc_read_pool *pool);
bool slc_read_pool_has_work(const struct slc_read_pool *pool);
/** Ends a read and notifies the loader's owner. With the mutex held. */
void slc_loader_end_read(SluiceTileLoader *loader, struct slc_read *read, SluiceResult result);
void slc_loader_signal_if_idle(SluiceTileLoader *loader);
/** Waits until a read can be collected, none is in progress, or slc_monotonic_time() is `until`.
 *  Returns false in the last case. Without the mutex, on the thread that collects. */
bool slc_loader_wait_for_read(SluiceTileLoader *loader, uint64_t until);

/** Reads once if the pool reads in jobs and no job runs. Returns whether it read. Without the
 * mutex, for threads that wait for the end of a read by other means. */
bool slc_loader_help(SluiceTileLoader *loader);

/** End of one attempt at a read. */
struct slc_read_outcome {
    SluiceResult result;
    SluiceImageFault fault;
    uint32_t region;  ///< failed region
    uint64_t latency; ///< ns
};

/** Reads one region at once, into the read's memory. */
SluiceResult slc_loader_read_region(const SluiceTileLoader *loader, const struct slc_read *read,
                                    const SluiceImageInfo *info, uint32_t region,
                                    SluiceImageFault *fault);
/** True if the read is not wanted any more. */
bool slc_read_is_dropped(const struct slc_read *read);
/** Notes a delivered region. With the mutex held, or on the thread that runs the read. */
void slc_read_region_done(struct slc_read *read, SluiceFormat format, uint32_t region);
/** Reports an attempt at a running read, and ends or delays the read. The mutex is held, and
 * released in between. */
void slc_loader_settle_read(SluiceTileLoader *loader, struct slc_read *read,
                            const struct slc_read_outcome *outcome);

#endif /* SLC_IMAGE_READ_POOL_H */
