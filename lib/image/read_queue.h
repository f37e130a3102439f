/**
 * The bookkeeping of a loader without its threads: a fixed number of reads, each free, queued by
 * priority, running or finished. Not synchronised; the loader holds a lock around every call.
 */
#ifndef SLC_IMAGE_READ_QUEUE_H
#define SLC_IMAGE_READ_QUEUE_H

#include <sluice/loader.h>

enum slc_read_state { SLC_READ_FREE, SLC_READ_QUEUED, SLC_READ_RUNNING, SLC_READ_FINISHED };

struct slc_read {
    enum slc_read_state state;
    uint64_t generation; ///< of the slot, so that old tickets are recognised
    uint64_t order;      ///< of submission
    uint32_t heap_index; ///< while queued
    uint32_t priority;
    SluiceImageSource *source;
    uint32_t region_count;
    SluiceImageRegion regions[SLUICE_MAX_READ_REGIONS];
    void *texels[SLUICE_MAX_READ_REGIONS];
    SluiceTileReadResult result;
};

struct slc_read_queue {
    uint32_t capacity;
    struct slc_read *reads;
    uint32_t *free_slots; ///< a stack
    uint32_t free_count;
    uint32_t *heap; ///< of queued slots, the most urgent first
    uint32_t heap_count;
    uint32_t *finished; ///< a ring of slots in the order in which they finished
    uint32_t finished_first, finished_count;
    uint64_t submitted;
};

/** `capacity` > 0. Errors: OUT_OF_HOST_MEMORY; nothing to finish then. */
SluiceResult slc_read_queue_init(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb,
                                 uint32_t capacity);
void slc_read_queue_finish(struct slc_read_queue *queue, const SluiceAllocationCallbacks *cb);

/** False when every slot is taken. */
bool slc_read_queue_submit(struct slc_read_queue *queue, const SluiceTileRead *read,
                           uint64_t *ticket);

/** The most urgent queued read, running from now on; NULL if none is queued. */
struct slc_read *slc_read_queue_start(struct slc_read_queue *queue);

/** Ends a running read, or a queued one that is dropped. */
void slc_read_queue_end(struct slc_read_queue *queue, struct slc_read *read, SluiceResult result,
                        uint64_t size);

/** The read of a ticket that is not collected yet, or NULL. */
struct slc_read *slc_read_queue_find(struct slc_read_queue *queue, uint64_t ticket);

/** The longest finished read's result, its slot being free again; false if none is finished. */
bool slc_read_queue_collect(struct slc_read_queue *queue, SluiceTileReadResult *result);

#endif /* SLC_IMAGE_READ_QUEUE_H */
