/*
 * Moves that empty the least used heaps. A move goes from a heap to one that is at least as full.
 * So each move raises the sum of squares of live tiles, and repeated calls end.
 */
#include "residency/defragment.h"

#include "base/alloc.h"
#include "residency/node.h"
#include "residency/node_list.h"
#include "residency/nodes.h"

#include <stdlib.h>

static uint32_t live_slots(const struct slc_machine *r, uint32_t heap)
{
    const struct slc_tile_heap *h = &r->heaps.heaps[heap];
    return r->heaps.capacity - h->free_count - h->retiring_count;
}

static bool is_movable(const struct slc_machine *r, uint32_t node)
{
    uint8_t state = slc_node_at(r, node)->state;
    return state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY ||
           state == SLC_NODE_RETIRING; /* leaves by itself */
}

static bool has_only_movable_tiles(const struct slc_machine *r, uint32_t heap)
{
    const struct slc_tile_heap *h = &r->heaps.heaps[heap];
    if (r->state_counts[SLUICE_TILE_STATE_ALLOCATED] +
            r->state_counts[SLUICE_TILE_STATE_CANCELED] ==
        0)
        return true;
    for (uint32_t slot = 0; slot < r->heaps.capacity; slot++)
        if (h->nodes[slot] && !is_movable(r, h->nodes[slot]))
            return false;
    return true;
}

static bool has_only_evictable_tiles(const struct slc_machine *r, uint32_t heap)
{
    for (uint32_t slot = 0; slot < r->heaps.capacity; slot++) {
        uint32_t node = r->heaps.heaps[heap].nodes[slot];
        bool stays = node && slc_node_at(r, node)->level == SLC_PACKED_CLASS &&
                     slc_node_at(r, node)->state != SLC_NODE_RETIRING;
        if (stays || (node && !is_movable(r, node)))
            return false;
    }
    return true;
}

/* Surveys ----------------------------------------------------------------------------------- */

enum standing {
    STANDING_EMPTY = 0, ///< without tiles from the start, or emptied
    STANDING_QUEUED,    ///< not examined yet, or not since it took a tile
    STANDING_STAYS      ///< cannot be emptied
};

/**
 * Survey of heaps, from the least used one on. A heap that cannot be emptied is examined again only
 * if it takes tiles: the room of other heaps only shrinks, and its own tiles do not change.
 */
struct survey {
    uint64_t *queue;        ///< QUEUED heaps: a min-heap of source_key, some too small
    uint64_t *destinations; ///< heaps with free slots, sorted by destination_key
    uint8_t *standing;      ///< [heaps.end]
    uint32_t queued, destination_count;
    uint32_t full;      ///< destinations before this one have no free slot left
    uint32_t level;     ///< live tiles of the heaps examined now
    uint64_t room;      ///< free slots of heaps with at least `level` live tiles
    uint64_t peer_room; ///< free slots of heaps that stay and have exactly `level` live tiles
    bool evicts;        ///< evict tiles instead of moving them; packed tiles stay
    bool risen;         ///< a heap with fewer live tiles has reached the level
};

/** Sort key of sources: fewest live tiles first, then the higher index. */
static uint64_t source_key(const struct slc_machine *r, uint32_t heap)
{
    return (uint64_t)live_slots(r, heap) << 32 | (UINT32_MAX - heap);
}

/** Sort key of destinations: fewest free slots first, then the lower index. */
static uint64_t destination_key(const struct slc_machine *r, uint32_t heap)
{
    return (uint64_t)r->heaps.heaps[heap].free_count << 32 | heap;
}

static int compare_keys(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

static void sift_down(struct slc_machine *r, struct survey *s, uint32_t at)
{
    uint64_t key = s->queue[at];
    for (uint32_t child; (child = 2 * at + 1) < s->queued; at = child) {
        child += child + 1 < s->queued && s->queue[child + 1] < s->queue[child];
        r->steps++;
        if (s->queue[child] >= key)
            break;
        s->queue[at] = s->queue[child];
    }
    s->queue[at] = key;
}

static void push(struct slc_machine *r, struct survey *s, uint64_t key)
{
    uint32_t at = s->queued++;
    for (; at > 0 && s->queue[(at - 1) / 2] > key; at = (at - 1) / 2, r->steps++)
        s->queue[at] = s->queue[(at - 1) / 2];
    s->queue[at] = key;
}

static void pop(struct slc_machine *r, struct survey *s)
{
    s->queue[0] = s->queue[--s->queued];
    if (s->queued > 0)
        sift_down(r, s, 0);
}

static size_t survey_size(const struct slc_machine *r)
{
    return r->heaps.end * (2 * sizeof(uint64_t) + 1);
}

/** Begins a survey of all heaps. `memory` has survey_size bytes. */
static struct survey begin_survey(struct slc_machine *r, void *memory)
{
    struct survey s = {.queue = memory};
    s.destinations = s.queue + r->heaps.end;
    s.standing = (uint8_t *)(s.destinations + r->heaps.end);
    for (uint32_t i = 0; i < r->heaps.end; i++, r->steps++) {
        const struct slc_tile_heap *h = &r->heaps.heaps[i];
        s.standing[i] = STANDING_EMPTY;
        if (h->free_count == SLC_HEAP_DEAD || live_slots(r, i) == 0)
            continue;
        s.standing[i] = STANDING_QUEUED;
        s.queue[s.queued++] = source_key(r, i);
        s.room += h->free_count;
    }
    for (uint32_t i = s.queued / 2; i-- > 0;)
        sift_down(r, &s, i);
    return s;
}

static void sort_destinations(const struct slc_machine *r, struct survey *s)
{
    for (uint32_t i = 0; i < r->heaps.end; i++)
        if (s->standing[i] != STANDING_EMPTY && r->heaps.heaps[i].free_count > 0)
            s->destinations[s->destination_count++] = destination_key(r, i);
    qsort(s->destinations, s->destination_count, sizeof *s->destinations, compare_keys);
}

/**
 * Takes the least used heap that can be emptied from the survey; the last one of equals. SLC_NONE
 * if there is none.
 */
static uint32_t next_source(struct slc_machine *r, struct survey *s)
{
    while (s->queued > 0) {
        uint32_t heap = UINT32_MAX - (uint32_t)s->queue[0], live = live_slots(r, heap);
        if (s->queue[0] != source_key(r, heap)) {
            s->queue[0] = source_key(r, heap);
            sift_down(r, s, 0);
            continue;
        }
        if (live > s->level) {
            s->room -= s->peer_room;
            s->peer_room = 0;
            s->level = live;
        }
        if (s->room < live)
            return SLC_NONE; /* fuller heaps need more room and find less */
        pop(r, s);
        uint32_t own = r->heaps.heaps[heap].free_count;
        bool leaves =
            s->evicts ? has_only_evictable_tiles(r, heap) : has_only_movable_tiles(r, heap);
        if (s->room - own >= live && leaves) {
            s->room -= own;
            s->standing[heap] = STANDING_EMPTY;
            return heap;
        }
        s->standing[heap] = STANDING_STAYS;
        if (!s->evicts || !r->heaps.heaps[heap].packed) /* evicted tiles may go to such a heap */
            s->peer_room += own;
    }
    return SLC_NONE;
}

/** Finds the fullest heap with room that is at least as full as the source, as an index of
 * `destinations`. */
static uint32_t find_destination(struct slc_machine *r, const struct survey *s, uint32_t source)
{
    for (uint32_t i = s->full; i < s->destination_count; i++, r->steps++) {
        uint32_t heap = (uint32_t)s->destinations[i];
        if (s->standing[heap] != STANDING_EMPTY && live_slots(r, heap) >= live_slots(r, source))
            return i;
    }
    assert(false); /* next_source counted the room */
    return SLC_NONE;
}

/** Takes a slot of a destination. Returns its heap. */
static uint32_t take_destination(struct slc_machine *r, struct survey *s, uint32_t at)
{
    uint64_t key = s->destinations[at] - (UINT64_C(1) << 32);
    uint32_t heap = (uint32_t)key, live = live_slots(r, heap);
    for (; at > s->full && s->destinations[at - 1] > key; at--, r->steps++)
        s->destinations[at] = s->destinations[at - 1];
    s->destinations[at] = key;
    s->full += key >> 32 == 0;
    if (s->standing[heap] == STANDING_STAYS && live < s->level) {
        s->risen |= live + 1 == s->level;
        return heap;
    }
    s->room--;
    if (s->standing[heap] == STANDING_STAYS) {
        s->peer_room -= r->heaps.heaps[heap].free_count;
        s->standing[heap] = STANDING_QUEUED;
        push(r, s, source_key(r, heap) + (UINT64_C(1) << 32));
    }
    return heap;
}

/* Moves ------------------------------------------------------------------------------------- */

static void leave_slot(struct slc_machine *r, uint32_t heap, uint32_t slot, uint64_t retire_value)
{
    if (retire_value <= r->completed_retire)
        slc_tile_heaps_give(&r->heaps, heap, slot);
    else
        slc_node_retire_slot(r, heap, slot, retire_value);
}

/** Receiver of moves. */
struct moves {
    uint32_t count, room;
    uint64_t retire_value;
    const struct slc_move_listener *listener;
};

static void move_tile(struct slc_machine *r, uint32_t node, uint32_t destination,
                      struct moves *moves)
{
    struct slc_node *n = slc_node_at(r, node);
    uint32_t heap = n->heap, slot = n->slot;
    n->slot = slc_tile_heaps_take_from(&r->heaps, destination, node);
    n->heap = destination;
    leave_slot(r, heap, slot, moves->retire_value);
    moves->count++;
    moves->listener->moved(moves->listener->user, n, r->heaps.heaps[heap].id, slot);
}

/** Moves tiles out of `source` while there is room for moves. */
static void empty_heap(struct slc_machine *r, struct survey *s, uint32_t source,
                       struct moves *moves)
{
    for (uint32_t slot = 0; slot < r->heaps.capacity && moves->count < moves->room; slot++) {
        uint32_t node = r->heaps.heaps[source].nodes[slot];
        if (!node || slc_node_at(r, node)->state == SLC_NODE_RETIRING)
            continue;
        uint32_t destination = take_destination(r, s, find_destination(r, s, source));
        move_tile(r, node, destination, moves);
    }
}

static void make_moves(struct slc_machine *r, void *memory, struct moves *moves)
{
    struct survey s;
    do {
        s = begin_survey(r, memory);
        for (uint32_t source; moves->count < moves->room && !s.risen;) {
            source = next_source(r, &s);
            if (source == SLC_NONE)
                break;
            if (s.destination_count == 0)
                sort_destinations(r, &s);
            empty_heap(r, &s, source, moves);
        }
    } while (s.risen && moves->count < moves->room);
}

SluiceResult slc_defragment(struct slc_machine *r, uint64_t retire_value, uint32_t room,
                            const struct slc_move_listener *listener)
{
    struct moves moves = {.room = room, .retire_value = retire_value, .listener = listener};
    /* One node per move stays for the old slot. An emptied heap is not filled again in the same
     * call, so a tile moves at most once per heap. */
    uint64_t movable = (uint64_t)r->state_counts[SLUICE_TILE_STATE_MAPPED] +
                       r->state_counts[SLUICE_TILE_STATE_STANDBY];
    uint64_t most = movable * r->heaps.live_count;
    if (most == 0 || room == 0)
        return SLUICE_SUCCESS;
    if (!slc_reserve_nodes(r, most < room ? most : room))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    void *memory = slc_alloc(r->cb, 1, survey_size(r));
    if (!memory)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    make_moves(r, memory, &moves);
    slc_free(r->cb, memory, 1, survey_size(r));
    return SLUICE_SUCCESS;
}

/* Evictions --------------------------------------------------------------------------------- */

/** Evicts a tile. False if it is evicted already, or its slot retires. */
static bool evict(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    if (n->state == SLUICE_TILE_STATE_MAPPED) {
        slc_node_evict_wanted(r, node);
        return true;
    }
    if (n->state != SLUICE_TILE_STATE_STANDBY || n->flags & SLC_NODE_LISTED)
        return false;
    slc_list_remove(r, &r->standby, node);
    n->flags |= SLC_NODE_LISTED;
    slc_list_append(r, &r->evicted, node);
    return true;
}

SluiceResult slc_evacuate(struct slc_machine *r, uint32_t room)
{
    if (room == 0 || r->heaps.live_count < 2)
        return SLUICE_SUCCESS;
    void *memory = slc_alloc(r->cb, 1, survey_size(r));
    if (!memory)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    struct survey s = begin_survey(r, memory);
    s.evicts = true;
    uint32_t heap = next_source(r, &s);
    for (uint32_t slot = 0; heap != SLC_NONE && slot < r->heaps.capacity && room > 0; slot++) {
        uint32_t node = r->heaps.heaps[heap].nodes[slot];
        room -= node && evict(r, node);
    }
    slc_free(r->cb, memory, 1, survey_size(r));
    return SLUICE_SUCCESS;
}
