/**
 * Read queue: state of a loader without threads and clock. It has a fixed number of reads, each
 * free, queued by priority, delayed until another attempt, running, waiting for another read, or
 * finished. Not synchronized: the loader holds a lock around every call.
 */
#ifndef SLC_IMAGE_READ_QUEUE_H
#define SLC_IMAGE_READ_QUEUE_H

#include "image/read_sources.h"
#include "image/retry.h"

#include <stdatomic.h>

enum slc_read_state {
    SLC_READ_FREE,
    SLC_READ_QUEUED,
    SLC_READ_DELAYED,
    SLC_READ_RUNNING,
    SLC_READ_WAITING, ///< waits for a region that another read of the pool is reading
    SLC_READ_FINISHED
};

/** Regions of a running read that its source has started. Guarded by the lock. */
struct slc_started {
    uint32_t pending;    ///< one bit per region that is not completed
    uint32_t calls;      ///< calls of the source in progress, which keep the read from ending
    bool starting;       ///< one of the calls starts regions
    uint32_t told;       ///< one bit per region whose source was told of a cancel
    SluiceResult result; ///< first result that is not SLUICE_SUCCESS
    uint32_t failed_region;
    SluiceFormat format;
    SluiceImageFault fault; ///< fault of the failed region
    uint64_t start_time;    ///< ns
    /** Memory of the read pool that the source writes. NULL: the read's own memory. */
    struct slc_shared_region *shared[SLUICE_MAX_READ_REGIONS];
};

/** Failure of another read that a read waited for. */
struct slc_joined_failure {
    SluiceResult result; ///< SLUICE_SUCCESS: no failure
    SluiceImageFault fault;
};

struct slc_read {
    enum slc_read_state state;
    uint64_t generation;       ///< generation of the slot, so that old tickets are recognized
    uint64_t order;            ///< order of submission
    struct slc_heap_node node; ///< in the source's queued reads, or in the delayed reads
    uint64_t due;              ///< DELAYED: due time
    uint32_t priority;
    struct slc_read_source *source;
    uint64_t running_size; ///< bytes that count against the limit while the read runs
    SluiceTileReadResult result;

    /* Used by the thread that runs the read, which also reads the constant fields above. */
    struct slc_attempts attempts;
    uint32_t region_count, done; ///< done: one bit per delivered region
    uint64_t done_size;          ///< bytes of the delivered regions
    SluiceImageRegion regions[SLUICE_MAX_READ_REGIONS];
    void *texels[SLUICE_MAX_READ_REGIONS];

    atomic_bool dropped; ///< not wanted any more
    bool holds_thread;   ///< RUNNING: occupies a thread
    bool is_copy;        ///< QUEUED, RUNNING: copies texels instead of reading the source
    struct slc_started started;

    /* Guarded by the lock. */
    struct slc_read *next_waiting;     ///< next read that waits for the awaited region
    struct slc_shared_region *awaited; ///< WAITING: region of the pool
    uint32_t awaited_region;           ///< WAITING: index of the read's own region
    uint64_t wait_time;                ///< ns; begin of the wait
    struct slc_joined_failure failed;  ///< not reported yet; constant while queued
    struct slc_shared_region *held;    ///< texels to copy; constant while queued
};

/** Limits, and running reads that count against them. Several queues may share one. */
struct slc_read_load {
    uint32_t max_running_per_source;
    uint32_t running_count;
    uint64_t max_running_size; ///< bytes; a single read may exceed it
    uint64_t running_size;
};

struct slc_read_queue {
    uint32_t capacity;
    struct slc_read_load own_load, *load; ///< `load`: `own_load`, or a shared one
    struct slc_read *reads;
    uint32_t *free_slots; ///< stack
    uint32_t free_count;
    uint32_t *finished; ///< ring of slots, in the order in which their reads finished
    uint32_t finished_first, finished_count;
    uint64_t submitted;

    struct slc_read_sources sources;
    const struct slc_shared_reads *shares; ///< kept texels; NULL: none
    struct slc_pairing_heap copies;        ///< queued reads that copy texels; without limits
    struct slc_pairing_heap startable;     ///< sources that may start another of their queued reads
    struct slc_pairing_heap delayed;       ///< delayed reads, by due time
    uint32_t queued_count, running_count, waiting_count;
    struct slc_read_statistics statistics; ///< statistics of all sources; counts delayed reads
};

struct slc_read_queue_limits {
    uint32_t capacity;               ///< > 0
    uint32_t source_count;           ///< sources that are remembered; at least the capacity
    uint32_t max_running_per_source; ///< > 0
    uint64_t max_running_size;
};

/** Makes a queue, which must not be moved. Errors: OUT_OF_HOST_MEMORY; nothing to finish then. */
SluiceResult slc_read_queue_init(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb,
                                 const struct slc_read_queue_limits *limits);
/** Counts reads against `load` instead of the queue's own limits. `peer`: another queue with this
 *  load, or NULL. Call it before the first read. */
void slc_read_queue_share(struct slc_read_queue *queue, struct slc_read_load *load,
                          struct slc_read_queue *peer);
/** Frees a queue without running reads. Queues that share its limits go on. */
void slc_read_queue_finish(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb);

/** Submits a read. False if every slot is taken. */
bool slc_read_queue_submit(struct slc_read_queue *queue, const SluiceTileRead *read,
                           uint64_t *ticket);

/** Returns the queue of a read. */
struct slc_read_queue *slc_read_queue_of(const struct slc_read *read);

/** Starts the most urgent copy, or else the most urgent read that may run. NULL if there is none at
 *  this time. */
struct slc_read *slc_read_queue_start(struct slc_read_queue *queue, uint64_t now);

/** Starts the most urgent copy. NULL if there is none. */
struct slc_read *slc_read_queue_start_copy(struct slc_read_queue *queue, uint64_t now);

/** Frees the thread of a running read, which its source will complete. */
void slc_read_queue_release_thread(struct slc_read_queue *queue, struct slc_read *read);

/** Returns when the first delayed read is due; UINT64_MAX: none is delayed. */
uint64_t slc_read_queue_next_due(const struct slc_read_queue *queue);

/** Counts an attempt at a running read, which took `latency` ns and ended with `result`, an error
 * at `offset`. The read still runs. */
void slc_read_queue_add_attempt(struct slc_read_queue *queue, struct slc_read *read,
                                SluiceResult result, uint64_t offset, uint64_t latency);

/** Delays a running read until `due`. */
void slc_read_queue_delay(struct slc_read_queue *queue, struct slc_read *read, uint64_t due);

/** Lets a running read wait until slc_read_queue_resume. */
void slc_read_queue_wait(struct slc_read_queue *queue, struct slc_read *read);
/** Queues a read that waits, or a running one. A copy that could not be made is queued as a read.
 */
void slc_read_queue_resume(struct slc_read_queue *queue, struct slc_read *read);

/** Ends a running read, or a queued, delayed or waiting one that is dropped. */
void slc_read_queue_end(struct slc_read_queue *queue, struct slc_read *read, SluiceResult result);

/** Returns the read of a ticket that is not collected yet, or NULL. */
struct slc_read *slc_read_queue_find(struct slc_read_queue *queue, uint64_t ticket);

/** Takes the result of the read that finished first, and frees its slot. False if none is finished.
 */
bool slc_read_queue_collect(struct slc_read_queue *queue, SluiceTileReadResult *result);

/** True if nothing is queued, delayed, running or waiting. */
bool slc_read_queue_is_idle(const struct slc_read_queue *queue);

/** Forgets a source and its statistics. NOT_READY, with nothing changed, while it has reads that
 * are not collected. */
SluiceResult slc_read_queue_forget(struct slc_read_queue *queue, const SluiceImageSource *source);

/** Writes the statistics of a source, or of all sources for NULL. Zeros for an unknown source. */
void slc_read_queue_write_statistics(const struct slc_read_queue *queue,
                                     const SluiceImageSource *source,
                                     SluiceTileLoaderStatistics *statistics);

#endif /* SLC_IMAGE_READ_QUEUE_H */
