/**
 * Fewest uploads that leave no level too coarse. Without a cap, every tile is uploaded once. With a
 * cap, Belady's rule applies: the tiles of a frame are fetched just before it, and replace those
 * whose next use is farthest. This is optimal, because all tiles have one size. Prefetching cannot
 * lower the count. Budget and latency are ignored. Tiles of a set count one by one.
 */
#include "clairvoyant.h"

#include <stdlib.h>

#define NO_USE UINT32_MAX

struct entry {
    uint32_t next, node; ///< `next`: frame of the next use, or NO_USE
};

struct far_heap {
    struct entry *entries;
    uint32_t count, room;
};

static void push(struct far_heap *heap, struct entry entry)
{
    if (heap->count == heap->room) {
        heap->room = heap->room ? heap->room * 2 : 1024;
        heap->entries = realloc(heap->entries, heap->room * sizeof entry);
        if (!heap->entries)
            exit(1);
    }
    uint32_t i = heap->count++;
    for (; i > 0 && heap->entries[(i - 1) / 2].next < entry.next; i = (i - 1) / 2)
        heap->entries[i] = heap->entries[(i - 1) / 2];
    heap->entries[i] = entry;
}

static void pop(struct far_heap *heap)
{
    struct entry last = heap->entries[--heap->count];
    uint32_t i = 0;
    for (uint32_t child; (child = 2 * i + 1) < heap->count; i = child) {
        if (child + 1 < heap->count && heap->entries[child + 1].next > heap->entries[child].next)
            child++;
        if (heap->entries[child].next <= last.next)
            break;
        heap->entries[i] = heap->entries[child];
    }
    heap->entries[i] = last;
}

struct cache {
    struct far_heap heap;
    uint32_t *next;    ///< per node: frame of its next use, to tell stale entries of the heap
    uint32_t *present; ///< per node: resident tiles of it
    uint64_t used;
};

/** Evicts the tile whose next use is farthest, if that is after `frame`. Returns false if there is
 * none. */
static bool evict_farthest(struct cache *c, uint32_t frame)
{
    while (c->heap.count) {
        struct entry top = c->heap.entries[0];
        if (c->present[top.node] == 0 || c->next[top.node] != top.next) {
            pop(&c->heap);
            continue;
        }
        if (top.next <= frame)
            return false;
        c->present[top.node]--;
        c->used--;
        return true;
    }
    return false;
}

static void serve_frame(const struct workload *w, struct cache *c, uint32_t frame, uint64_t cap,
                        struct belady *result)
{
    uint64_t instant = 0, unserved = 0;
    for (uint32_t i = w->frame_first[frame]; i < w->frame_first[frame + 1]; i++) {
        const struct node *node = &w->nodes[w->frame_uses[i].node];
        if (node->packed)
            continue;
        instant += node->size;
        for (uint32_t *p = &c->present[w->frame_uses[i].node]; *p < node->size; ++*p) {
            if (c->used == cap && !evict_farthest(c, frame)) {
                unserved += node->size - *p;
                break;
            }
            c->used++;
            result->uploads++;
        }
    }
    result->largest_instant = instant > result->largest_instant ? instant : result->largest_instant;
    result->frames_over_cap += unserved > 0;
    result->unserved += unserved;
    for (uint32_t i = w->frame_first[frame]; i < w->frame_first[frame + 1]; i++) {
        uint32_t node = w->frame_uses[i].node, use = w->frame_uses[i].use + 1;
        c->next[node] = use < w->nodes[node + 1].first_use ? w->uses[use].frame : NO_USE;
        if (!w->nodes[node].packed)
            push(&c->heap, (struct entry){c->next[node], node});
    }
}

struct belady clv_belady(const struct workload *w, uint64_t cap)
{
    struct belady result = {.uploads = w->packed_tiles, .distinct = w->packed_tiles};
    struct cache cache = {.next = clv_alloc(w->node_count, sizeof *cache.next),
                          .present = clv_alloc(w->node_count, sizeof *cache.present)};
    for (uint32_t n = 0; n < w->node_count; n++) {
        bool used = w->nodes[n].first_use < w->nodes[n + 1].first_use;
        cache.next[n] = used ? w->uses[w->nodes[n].first_use].frame : NO_USE;
        if (used && !w->nodes[n].packed)
            result.distinct += w->nodes[n].size;
    }
    for (uint32_t frame = 0; frame < w->frame_count; frame++)
        serve_frame(w, &cache, frame, cap, &result);
    free(cache.heap.entries);
    free(cache.next);
    free(cache.present);
    return result;
}
