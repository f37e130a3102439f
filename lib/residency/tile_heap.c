#include "residency/tile_heap.h"

#include "base/alloc.h"
#include "base/bits.h"

#include <assert.h>
#include <string.h>

/*
 * Two levels of bits over the buckets: bit b of level 0 says that bucket b is not empty, bit w of
 * level 1 that word w of level 0 is not 0. With 2^20 + 1 buckets level 1 has 257 words.
 */
enum { BIT_LEVELS = 2 };

static void bit_level_offsets(uint32_t bit_count, uint32_t offsets[BIT_LEVELS + 1])
{
    uint32_t at = 0, bits = bit_count;
    for (int level = 0; level < BIT_LEVELS; level++) {
        offsets[level] = at;
        bits = (bits + 63) / 64;
        at += bits;
    }
    offsets[BIT_LEVELS] = at;
}

static void set_bit(struct slc_tile_heaps *h, uint32_t bit)
{
    uint32_t offsets[BIT_LEVELS + 1];
    bit_level_offsets(h->capacity + 1, offsets);
    for (int level = 0; level < BIT_LEVELS; level++, bit /= 64)
        h->bits[offsets[level] + bit / 64] |= UINT64_C(1) << bit % 64;
}

static void clear_bit(struct slc_tile_heaps *h, uint32_t bit)
{
    uint32_t offsets[BIT_LEVELS + 1];
    bit_level_offsets(h->capacity + 1, offsets);
    for (int level = 0; level < BIT_LEVELS; level++, bit /= 64) {
        uint64_t *word = &h->bits[offsets[level] + bit / 64];
        *word &= ~(UINT64_C(1) << bit % 64);
        if (*word)
            break;
    }
}

/** Finds the lowest set bit above 0; UINT32_MAX if there is none. Bit 0 means full heaps. */
static uint32_t find_bit_above_zero(const struct slc_tile_heaps *h)
{
    uint32_t offsets[BIT_LEVELS + 1];
    bit_level_offsets(h->capacity + 1, offsets);
    uint64_t low = h->bits[0] & ~UINT64_C(1);
    if (low)
        return slc_lowest_bit64(low);
    /* the rest of the words under summary word 0, then summary by summary */
    for (uint32_t word = 1; word < 64 && offsets[0] + word < offsets[1]; word++)
        if (h->bits[word])
            return word * 64 + slc_lowest_bit64(h->bits[word]);
    for (uint32_t summary = 1; offsets[1] + summary < offsets[2]; summary++) {
        uint64_t words = h->bits[offsets[1] + summary];
        if (words) {
            uint32_t word = summary * 64 + slc_lowest_bit64(words);
            return word * 64 + slc_lowest_bit64(h->bits[word]);
        }
    }
    return UINT32_MAX;
}

static void bucket_insert(struct slc_tile_heaps *h, uint32_t index)
{
    struct slc_tile_heap *heap = &h->heaps[index];
    uint32_t first = h->buckets[heap->free_count];
    heap->prev = UINT32_MAX;
    heap->next = first;
    if (first != UINT32_MAX)
        h->heaps[first].prev = index;
    else
        set_bit(h, heap->free_count);
    h->buckets[heap->free_count] = index;
}

static void bucket_remove(struct slc_tile_heaps *h, uint32_t index)
{
    struct slc_tile_heap *heap = &h->heaps[index];
    if (heap->next != UINT32_MAX)
        h->heaps[heap->next].prev = heap->prev;
    if (heap->prev != UINT32_MAX)
        h->heaps[heap->prev].next = heap->next;
    else
        h->buckets[heap->free_count] = heap->next;
    if (h->buckets[heap->free_count] == UINT32_MAX)
        clear_bit(h, heap->free_count);
}

SluiceResult slc_tile_heaps_init(struct slc_tile_heaps *h, const SluiceAllocationCallbacks *cb,
                                 const SluiceHeapAllocator *allocator, uint32_t capacity,
                                 uint32_t tile_size)
{
    uint32_t offsets[BIT_LEVELS + 1];
    *h = (struct slc_tile_heaps){.cb = cb,
                                 .allocator = *allocator,
                                 .capacity = capacity,
                                 .tile_size = tile_size,
                                 .open = UINT32_MAX,
                                 .loose = UINT32_MAX};
    bit_level_offsets(capacity + 1, offsets);
    h->bit_words = offsets[BIT_LEVELS];
    h->buckets = slc_alloc(cb, (size_t)capacity + 1, sizeof *h->buckets);
    h->bits = slc_calloc(cb, h->bit_words, sizeof *h->bits);
    if (!h->buckets || !h->bits) {
        slc_tile_heaps_finish(h);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    memset(h->buckets, 0xFF, ((size_t)capacity + 1) * sizeof *h->buckets);
    return SLUICE_SUCCESS;
}

static uint32_t word_count(const struct slc_tile_heaps *h)
{
    return (h->capacity + 63) / 64;
}

static void free_books(const struct slc_tile_heaps *h, const struct slc_tile_heap *heap)
{
    slc_free(h->cb, heap->free, word_count(h), sizeof *heap->free);
    slc_free(h->cb, heap->nodes, h->capacity, sizeof *heap->nodes);
}

void slc_tile_heaps_finish(struct slc_tile_heaps *h)
{
    for (uint32_t i = 0; i < h->end; i++) {
        if (h->heaps[i].free_count == SLC_HEAP_DEAD)
            continue;
        h->allocator.pfnReleaseHeap(h->allocator.pUserData, h->heaps[i].id);
        free_books(h, &h->heaps[i]);
    }
    if (h->cb) {
        slc_free(h->cb, h->heaps, h->room, sizeof *h->heaps);
        slc_map_finish(&h->ids, h->cb);
        slc_free(h->cb, h->buckets, (size_t)h->capacity + 1, sizeof *h->buckets);
        slc_free(h->cb, h->bits, h->bit_words, sizeof *h->bits);
    }
    *h = (struct slc_tile_heaps){0};
}

static SluiceResult grow_table(struct slc_tile_heaps *h)
{
    uint32_t room = h->room ? h->room * 2 : 8;
    if (room >= 1u << 30 || slc_map_reserve(&h->ids, h->cb, room) != SLUICE_SUCCESS)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    struct slc_tile_heap *heaps = slc_regrow(h->cb, h->heaps, h->room, room, sizeof *heaps);
    if (!heaps)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    h->heaps = heaps;
    h->room = room;
    return SLUICE_SUCCESS;
}

/** Makes room for one more heap: a dead entry, or an entry at the end. */
static SluiceResult reserve_entry(struct slc_tile_heaps *h)
{
    return h->live_count < h->room ? SLUICE_SUCCESS : grow_table(h);
}

/** Returns the first dead entry, or a new one at the end. */
static uint32_t unused_entry(struct slc_tile_heaps *h)
{
    if (h->live_count == h->end)
        return h->end++;
    while (h->heaps[h->dead_from].free_count != SLC_HEAP_DEAD)
        h->dead_from++;
    return h->dead_from;
}

/** Makes the records of a heap whose slots are all free. False, with nothing allocated, without
 * memory. */
static bool make_books(const struct slc_tile_heaps *h, struct slc_tile_heap *heap)
{
    *heap = (struct slc_tile_heap){.free_count = h->capacity};
    heap->free = slc_alloc(h->cb, word_count(h), sizeof *heap->free);
    heap->nodes = slc_calloc(h->cb, h->capacity, sizeof *heap->nodes);
    if (!heap->free || !heap->nodes) {
        free_books(h, heap);
        return false;
    }
    memset(heap->free, 0xFF, word_count(h) * sizeof *heap->free);
    if (h->capacity % 64)
        heap->free[word_count(h) - 1] = (UINT64_C(1) << h->capacity % 64) - 1;
    return true;
}

static void enter_heap(struct slc_tile_heaps *h, uint32_t index, const struct slc_tile_heap *heap)
{
    h->heaps[index] = *heap;
    slc_map_add(&h->ids, heap->id, index);
    h->live_count++;
    h->empty_count++;
    h->free_total += h->capacity;
}

SluiceResult slc_tile_heaps_add(struct slc_tile_heaps *h, SluiceResult *answer, uint32_t *heap_id)
{
    struct slc_tile_heap heap;
    if (!make_books(h, &heap))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (reserve_entry(h) != SLUICE_SUCCESS) {
        free_books(h, &heap);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    *heap_id = 0;
    *answer = h->allocator.pfnAllocateHeap(h->allocator.pUserData,
                                           (uint64_t)h->capacity * h->tile_size, heap_id);
    if (*answer != SLUICE_SUCCESS || slc_tile_heaps_find(h, *heap_id) != UINT32_MAX) {
        free_books(h, &heap);
        return SLUICE_BUDGET_REACHED;
    }
    heap.id = *heap_id;
    uint32_t index = unused_entry(h);
    enter_heap(h, index, &heap);
    bucket_insert(h, index);
    return SLUICE_SUCCESS;
}

static void add_loose(struct slc_tile_heaps *h, uint32_t index)
{
    h->heaps[index].loose = true;
    h->heaps[index].next = h->loose;
    h->loose = index;
}

/** Removes the heap from its bucket until heaps are sorted again. */
static void loosen(struct slc_tile_heaps *h, uint32_t index)
{
    const struct slc_tile_heap *heap = &h->heaps[index];
    if (heap->loose || heap->packed)
        return;
    bucket_remove(h, index);
    add_loose(h, index);
}

static void put_loose_back(struct slc_tile_heaps *h)
{
    h->open = UINT32_MAX;
    while (h->loose != UINT32_MAX) {
        uint32_t index = h->loose;
        h->loose = h->heaps[index].next;
        h->heaps[index].loose = false;
        bucket_insert(h, index);
    }
}

static uint32_t lowest_free(struct slc_tile_heap *heap)
{
    while (!heap->free[heap->low])
        heap->low++;
    return heap->low * 64 + slc_lowest_bit64(heap->free[heap->low]);
}

static void take_slot(struct slc_tile_heaps *h, struct slc_tile_heap *heap, uint32_t slot,
                      uint32_t node)
{
    heap->free[slot / 64] &= ~(UINT64_C(1) << slot % 64);
    h->empty_count -= heap->free_count == h->capacity;
    heap->free_count--;
    heap->nodes[slot] = node;
    h->free_total--;
    h->packed_free -= heap->packed;
}

/** Returns a heap with the fewest free slots, at least one. Such a heap must exist. */
static uint32_t fullest(struct slc_tile_heaps *h)
{
    if (h->open != UINT32_MAX && h->heaps[h->open].free_count > 0)
        return h->open;
    put_loose_back(h);
    uint32_t bucket = find_bit_above_zero(h);
    assert(bucket != UINT32_MAX);
    uint32_t found = h->buckets[bucket];
    loosen(h, found);
    return h->open = found;
}

/** Returns the first heap for packed tiles with a free slot. Such a heap must exist. */
static uint32_t first_packed(struct slc_tile_heaps *h)
{
    const struct slc_tile_heap *heaps = h->heaps;
    while (!heaps[h->packed_from].packed || heaps[h->packed_from].free_count == 0)
        h->packed_from++;
    return h->packed_from;
}

/** Makes an empty heap a heap for packed tiles. An empty heap must exist. */
static void separate(struct slc_tile_heaps *h)
{
    put_loose_back(h);
    uint32_t index = h->buckets[h->capacity];
    bucket_remove(h, index);
    h->heaps[index].packed = true;
    h->packed_free += h->capacity;
    h->packed_from = index < h->packed_from ? index : h->packed_from;
}

void slc_tile_heaps_settle(struct slc_tile_heaps *h)
{
    put_loose_back(h);
}

bool slc_tile_heaps_take(struct slc_tile_heaps *h, uint32_t node, uint32_t *heap, uint32_t *slot)
{
    if (h->free_total == 0)
        return false; /* equal heaps keep their order: the caller's call may still fail */
    *heap = h->free_total > h->packed_free ? fullest(h) : first_packed(h);
    *slot = lowest_free(&h->heaps[*heap]);
    take_slot(h, &h->heaps[*heap], *slot, node);
    return true;
}

bool slc_tile_heaps_take_packed(struct slc_tile_heaps *h, uint32_t node, uint32_t *heap,
                                uint32_t *slot)
{
    if (h->packed_free == 0 && h->empty_count == 0)
        return false;
    if (h->packed_free == 0)
        separate(h);
    *heap = first_packed(h);
    *slot = lowest_free(&h->heaps[*heap]);
    take_slot(h, &h->heaps[*heap], *slot, node);
    return true;
}

uint32_t slc_tile_heaps_take_from(struct slc_tile_heaps *h, uint32_t heap_index, uint32_t node)
{
    struct slc_tile_heap *heap = &h->heaps[heap_index];
    assert(heap->free_count != SLC_HEAP_DEAD && heap->free_count > 0);
    loosen(h, heap_index);
    h->open = UINT32_MAX; /* the heap may become the fullest */
    uint32_t slot = lowest_free(heap);
    take_slot(h, heap, slot, node);
    return slot;
}

void slc_tile_heaps_give(struct slc_tile_heaps *h, uint32_t heap_index, uint32_t slot)
{
    struct slc_tile_heap *heap = &h->heaps[heap_index];
    assert(heap->free_count < h->capacity && heap->nodes[slot] != 0);
    /* another heap may be fuller now, or this heap if it was full */
    if (heap_index == h->open || heap->free_count == 0)
        h->open = UINT32_MAX;
    loosen(h, heap_index);
    heap->free[slot / 64] |= UINT64_C(1) << slot % 64;
    heap->low = slot / 64 < heap->low ? slot / 64 : heap->low;
    heap->free_count++;
    heap->nodes[slot] = 0;
    h->free_total++;
    h->empty_count += heap->free_count == h->capacity;
    if (!heap->packed)
        return;
    h->packed_free++;
    h->packed_from = heap_index < h->packed_from ? heap_index : h->packed_from;
    if (heap->free_count < h->capacity)
        return;
    h->packed_free -= h->capacity;
    heap->packed = false;
    add_loose(h, heap_index);
}

uint32_t slc_tile_heaps_find(const struct slc_tile_heaps *h, uint32_t id)
{
    return h->live_count ? slc_map_get(&h->ids, id) : UINT32_MAX;
}

void slc_tile_heaps_release(struct slc_tile_heaps *h, uint32_t heap_index)
{
    struct slc_tile_heap *heap = &h->heaps[heap_index];
    assert(heap->free_count == h->capacity);
    put_loose_back(h);
    bucket_remove(h, heap_index);
    h->allocator.pfnReleaseHeap(h->allocator.pUserData, heap->id);
    free_books(h, heap);
    slc_map_remove(&h->ids, heap->id);
    *heap = (struct slc_tile_heap){.free_count = SLC_HEAP_DEAD};
    h->dead_from = heap_index < h->dead_from ? heap_index : h->dead_from;
    h->live_count--;
    h->empty_count--;
    h->free_total -= h->capacity;
}

uint32_t slc_tile_heaps_reserved(const struct slc_tile_heaps *h)
{
    uint64_t slots = (uint64_t)h->live_count * h->capacity;
    return slots / 16 < 64 ? (uint32_t)(slots / 16) : 64;
}

/* Snapshots --------------------------------------------------------------------------------- */

/** Value of `prev` of a heap that is neither in a bucket nor loose. */
#define UNLINKED (UINT32_MAX - 1)

SluiceResult slc_tile_heaps_restore_dead(struct slc_tile_heaps *h)
{
    if (h->end == h->room && grow_table(h) != SLUICE_SUCCESS)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    h->heaps[h->end++] = (struct slc_tile_heap){.free_count = SLC_HEAP_DEAD};
    return SLUICE_SUCCESS;
}

SluiceResult slc_tile_heaps_restore(struct slc_tile_heaps *h, uint32_t id, bool packed)
{
    struct slc_tile_heap heap;
    if (slc_tile_heaps_find(h, id) != UINT32_MAX)
        return SLUICE_ERROR_CORRUPT_DATA;
    if (!make_books(h, &heap))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (h->end == h->room && grow_table(h) != SLUICE_SUCCESS) {
        free_books(h, &heap);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    heap.id = id;
    heap.packed = packed;
    heap.prev = UNLINKED;
    enter_heap(h, h->end++, &heap);
    h->packed_free += packed ? h->capacity : 0;
    return SLUICE_SUCCESS;
}

bool slc_tile_heaps_restore_slot(struct slc_tile_heaps *h, uint32_t index, uint32_t slot,
                                 uint32_t node)
{
    if (index >= h->end || slot >= h->capacity)
        return false;
    struct slc_tile_heap *heap = &h->heaps[index];
    if (heap->free_count == SLC_HEAP_DEAD || heap->nodes[slot])
        return false;
    take_slot(h, heap, slot, node);
    return true;
}

bool slc_tile_heaps_restore_order(struct slc_tile_heaps *h, uint32_t index, uint32_t behind,
                                  bool loose)
{
    if (index >= h->end)
        return false;
    struct slc_tile_heap *heap = &h->heaps[index];
    if (heap->free_count == SLC_HEAP_DEAD || heap->packed || heap->prev != UNLINKED)
        return false;
    uint32_t *first = loose ? &h->loose : &h->buckets[heap->free_count];
    if (behind == UINT32_MAX && *first != UINT32_MAX)
        return false;
    heap->loose = loose;
    heap->prev = behind;
    heap->next = UINT32_MAX;
    if (behind != UINT32_MAX)
        h->heaps[behind].next = index;
    else
        *first = index;
    if (!loose)
        set_bit(h, heap->free_count);
    return true;
}
