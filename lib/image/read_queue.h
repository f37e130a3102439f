/**
 * The bookkeeping of a loader without its threads and without a clock: a fixed number of reads,
 * each free, queued by priority, delayed until another attempt, running, waiting for another read
 * or finished. Not synchronized; the loader holds a lock around every call.
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
    SLC_READ_WAITING, ///< for a region that another read of the pool is reading
    SLC_READ_FINISHED
};

/** Regions of a running read that its source has started. With the lock held. */
struct slc_started {
    uint32_t pending;    ///< a bit for each region that is not completed
    uint32_t calls;      ///< of the source that are in progress: the read cannot end
    bool starting;       ///< one of them starts regions
    uint32_t told;       ///< a bit for each region whose source was told of a cancel
    SluiceResult result; ///< the first one that is not SLUICE_SUCCESS
    uint32_t failed_region;
    SluiceFormat format;
    SluiceImageFault fault; ///< of the failed region
    uint64_t start_time;    ///< ns
    /** Texels of a read pool that the source writes. NULL: it writes those of the read. */
    struct slc_shared_region *shared[SLUICE_MAX_READ_REGIONS];
};

/** A read that a read waited for has failed. */
struct slc_joined_failure {
    SluiceResult result; ///< SLUICE_SUCCESS: there is none
    SluiceImageFault fault;
};

struct slc_read {
    enum slc_read_state state;
    uint64_t generation;       ///< of the slot, so that old tickets are recognized
    uint64_t order;            ///< of submission
    struct slc_heap_node node; ///< among its source's queued reads, or among the delayed ones
    uint64_t due;              ///< while delayed
    uint32_t priority;
    struct slc_read_source *source;
    uint64_t running_size; ///< bytes that it counts for while it runs
    SluiceTileReadResult result;

    /* The thread that runs it has these to itself, and reads those above that do not change. */
    struct slc_attempts attempts;
    uint32_t region_count, done; ///< a bit for each region that is delivered
    uint64_t done_size;          ///< their bytes
    SluiceImageRegion regions[SLUICE_MAX_READ_REGIONS];
    void *texels[SLUICE_MAX_READ_REGIONS];

    atomic_bool dropped; ///< nobody wants it any more
    bool holds_thread;   ///< while it runs
    bool is_copy;        ///< while it is queued or runs: its source is not asked
    struct slc_started started;

    /* With the lock held. */
    struct slc_read *next_waiting;     ///< for the same region
    struct slc_shared_region *awaited; ///< while it waits
    uint32_t awaited_region;           ///< of its own
    uint64_t wait_time;                ///< ns; begin of the wait
    struct slc_joined_failure failed;  ///< not told yet; changes while it is not queued
    struct slc_shared_region *held;    ///< texels to copy; changes while it is not queued
};

/** Limits, and what runs of them. Several queues may share it. */
struct slc_read_load {
    uint32_t max_running_per_source;
    uint32_t running_count;
    uint64_t max_running_size; ///< bytes; a single read may exceed it
    uint64_t running_size;
};

struct slc_read_queue {
    uint32_t capacity;
    struct slc_read_load own_load, *load; ///< `load` is `own_load`, or the one that queues share
    struct slc_read *reads;
    uint32_t *free_slots; ///< a stack
    uint32_t free_count;
    uint32_t *finished; ///< a ring of slots in the order in which they finished
    uint32_t finished_first, finished_count;
    uint64_t submitted;

    struct slc_read_sources sources;
    const struct slc_shared_reads *shares; ///< texels that are kept; NULL: none
    struct slc_pairing_heap copies;        ///< queued reads of texels that are there; no limits
    struct slc_pairing_heap startable; ///< sources that have room for another of their queued reads
    struct slc_pairing_heap delayed;   ///< reads, the first one due in front
    uint32_t queued_count, running_count, waiting_count;
    struct slc_read_statistics statistics; ///< of all sources; knows how many are delayed
};

struct slc_read_queue_limits {
    uint32_t capacity;               ///< > 0
    uint32_t source_count;           ///< remembered; at least the capacity
    uint32_t max_running_per_source; ///< > 0
    uint64_t max_running_size;
};

/** Errors: OUT_OF_HOST_MEMORY; nothing to finish then. Must not be moved afterwards. */
SluiceResult slc_read_queue_init(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb,
                                 const struct slc_read_queue_limits *limits);
/** Counts reads against `load` instead of the queue's own limits. `peer`: another queue that does,
 *  or NULL. Before the first read. */
void slc_read_queue_share(struct slc_read_queue *queue, struct slc_read_load *load,
                          struct slc_read_queue *peer);
/** Nothing of it is running. Queues that it shares limits with go on. */
void slc_read_queue_finish(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb);

/** False when every slot is taken. */
bool slc_read_queue_submit(struct slc_read_queue *queue, const SluiceTileRead *read,
                           uint64_t *ticket);

/** The queue that a read is in. */
struct slc_read_queue *slc_read_queue_of(const struct slc_read *read);

/** The most urgent copy, or if there is none, the most urgent read that may run, running from now
 *  on. NULL if there is none at this time. */
struct slc_read *slc_read_queue_start(struct slc_read_queue *queue, uint64_t now);

/** The most urgent copy, running from now on, or NULL. */
struct slc_read *slc_read_queue_start_copy(struct slc_read_queue *queue, uint64_t now);

/** The thread of a running read is free for other reads: its source completes it. */
void slc_read_queue_release_thread(struct slc_read_queue *queue, struct slc_read *read);

/** When the first delayed read is due; UINT64_MAX: none is delayed. */
uint64_t slc_read_queue_next_due(const struct slc_read_queue *queue);

/** An attempt at a running read took `latency` ns and ended with `result`, an error at `offset`.
 * The read still runs. */
void slc_read_queue_add_attempt(struct slc_read_queue *queue, struct slc_read *read,
                                SluiceResult result, uint64_t offset, uint64_t latency);

/** Puts a running read aside until `due`. */
void slc_read_queue_delay(struct slc_read_queue *queue, struct slc_read *read, uint64_t due);

/** Puts a running read aside until slc_read_queue_resume. */
void slc_read_queue_wait(struct slc_read_queue *queue, struct slc_read *read);
/** Queues a read that waits, or a running one. A copy that could not be made is queued as a read.
 */
void slc_read_queue_resume(struct slc_read_queue *queue, struct slc_read *read);

/** Ends a running read, or a queued, delayed or waiting one that is dropped. */
void slc_read_queue_end(struct slc_read_queue *queue, struct slc_read *read, SluiceResult result);

/** The read of a ticket that is not collected yet, or NULL. */
struct slc_read *slc_read_queue_find(struct slc_read_queue *queue, uint64_t ticket);

/** The longest finished read's result, its slot being free again; false if none is finished. */
bool slc_read_queue_collect(struct slc_read_queue *queue, SluiceTileReadResult *result);

/** Whether nothing is queued, delayed, running or waiting. */
bool slc_read_queue_is_idle(const struct slc_read_queue *queue);

/** Drops what is known of a source. NOT_READY, and nothing has changed, while it has reads that are
 *  not collected. */
SluiceResult slc_read_queue_forget(struct slc_read_queue *queue, const SluiceImageSource *source);

/** Of a source, zeros for an unknown one, or of all for NULL. */
void slc_read_queue_write_statistics(const struct slc_read_queue *queue,
                                     const SluiceImageSource *source,
                                     SluiceTileLoaderStatistics *statistics);

#endif /* SLC_IMAGE_READ_QUEUE_H */
