/** Tile slots in the application's heaps: constant time, the fullest heap first. */
#ifndef SLC_RESIDENCY_TILE_HEAP_H
#define SLC_RESIDENCY_TILE_HEAP_H

#include <sluice/base.h>
#include <sluice/heap.h>

#include "base/map.h"

struct slc_tile_heap {
    uint32_t id;         ///< id of the application
    uint32_t free_count; ///< SLC_HEAP_DEAD: this entry is unused
    uint32_t retiring_count;
    uint32_t prev, next; ///< heaps of the same bucket; UINT32_MAX ends
    bool loose;          ///< in no bucket until heaps are sorted
    bool packed;         ///< for packed tiles, until empty; in no bucket
    uint32_t low;        ///< words of `free` below this one are 0
    uint64_t *free;      ///< owned; one bit per free slot
    uint32_t *nodes;     ///< owned, [capacity]: node in each slot; 0: none
};

#define SLC_HEAP_DEAD UINT32_MAX

struct slc_tile_heaps {
    const SluiceAllocationCallbacks *cb;
    SluiceHeapAllocator allocator;
    uint32_t capacity; ///< slots per heap
    uint32_t tile_size;
    struct slc_tile_heap *heaps; ///< owned, [end], dead ones in between
    uint32_t end, room, live_count;
    uint32_t dead_from; ///< no entry before this one is dead
    struct slc_map ids; ///< id of the application -> entry of a live heap; capacity `room`
    uint32_t loose;     ///< heaps in no bucket, linked by `next`
    uint32_t
        open; ///< loose heap that slots are taken from while no heap is fuller; UINT32_MAX: none
    uint32_t *buckets; ///< owned, [capacity + 1]: first heap by number of free slots
    uint64_t *bits;    ///< owned; one bit per bucket that is not empty, and summary words of them
    uint32_t bit_words;
    uint64_t free_total;
    uint64_t packed_free; ///< free slots of heaps for packed tiles
    uint32_t packed_from; ///< heaps for packed tiles before this one are full
    uint32_t empty_count; ///< heaps with all slots free
};

SluiceResult slc_tile_heaps_init(struct slc_tile_heaps *h, const SluiceAllocationCallbacks *cb,
                                 const SluiceHeapAllocator *allocator, uint32_t capacity,
                                 uint32_t tile_size);
/** Releases every heap. A zeroed struct is fine. */
void slc_tile_heaps_finish(struct slc_tile_heaps *h);

/**
 * Adds a heap from the allocator. `*answer`: the allocator's result, `*heap_id`: its id.
 * OUT_OF_HOST_MEMORY, without calling the allocator, if there is no memory for the heap's records.
 */
SluiceResult slc_tile_heaps_add(struct slc_tile_heaps *h, SluiceResult *answer, uint32_t *heap_id);

/**
 * Takes the lowest slot of a heap with the fewest free ones and writes heap index and slot. Takes
 * from heaps for packed tiles if no other has a free slot. Returns false, with nothing changed, if
 * no slot is free.
 */
bool slc_tile_heaps_take(struct slc_tile_heaps *h, uint32_t node, uint32_t *heap, uint32_t *slot);
/**
 * Takes the lowest slot of a heap for packed tiles. Makes an empty heap one if they are full.
 * Returns false, with nothing changed, if no heap is empty either.
 */
bool slc_tile_heaps_take_packed(struct slc_tile_heaps *h, uint32_t node, uint32_t *heap,
                                uint32_t *slot);
/**
 * Sorts heaps whose slots were taken or given since the last sort back among heaps with equally
 * many free slots. Which of equal heaps slc_tile_heaps_take prefers depends on when heaps are
 * sorted, so a call that can still fail must not sort them.
 */
void slc_tile_heaps_settle(struct slc_tile_heaps *h);
/** Takes the lowest free slot of this heap, which must have one. */
uint32_t slc_tile_heaps_take_from(struct slc_tile_heaps *h, uint32_t heap, uint32_t node);
/** Returns the slots that only packed tiles may take: one in 16, at most 64. */
uint32_t slc_tile_heaps_reserved(const struct slc_tile_heaps *h);
void slc_tile_heaps_give(struct slc_tile_heaps *h, uint32_t heap, uint32_t slot);

/** Returns the index of the live heap with the application's `id`, or UINT32_MAX. */
uint32_t slc_tile_heaps_find(const struct slc_tile_heaps *h, uint32_t id);
/** Releases an empty heap. */
void slc_tile_heaps_release(struct slc_tile_heaps *h, uint32_t heap);

/*
 * Snapshots: entries are restored in the order of their indices, then slots, then the order of the
 * heaps.
 */

/** Appends an unused entry. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_tile_heaps_restore_dead(struct slc_tile_heaps *h);
/** Appends a heap whose slots are all free. Errors: OUT_OF_HOST_MEMORY; CORRUPT_DATA: the id lives.
 */
SluiceResult slc_tile_heaps_restore(struct slc_tile_heaps *h, uint32_t id, bool packed);
/** Takes one slot. Returns false, with nothing changed, if there is none or it is taken. */
bool slc_tile_heaps_restore_slot(struct slc_tile_heaps *h, uint32_t heap, uint32_t slot,
                                 uint32_t node);
/**
 * Appends a heap to the loose ones or to its bucket, behind the last heap of that list; UINT32_MAX:
 * it is the first one. Returns false if the heap cannot stand there.
 */
bool slc_tile_heaps_restore_order(struct slc_tile_heaps *h, uint32_t heap, uint32_t behind,
                                  bool loose);

#endif /* SLC_RESIDENCY_TILE_HEAP_H */
