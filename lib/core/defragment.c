/*
 * Copies that empty the least used heaps. A move goes from a heap to one that is at least as full,
 * so the sum of the squares of their fill grows with each and calls without changes in between end.
 */
#include "core/internal.h"

static uint32_t live_slots(const slc_manager *m, uint32_t heap)
{
    const struct slc_tile_heap *h = &m->heaps.heaps[heap];
    return m->heaps.capacity - h->free_count - h->retiring_count;
}

static bool is_movable(const slc_manager *m, uint32_t node)
{
    uint8_t state = slc_node_at(m, node)->state;
    return state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY ||
           state == SLC_NODE_RETIRING; /* leaves by itself */
}

/** Free slots in the heaps that tiles of `source` may move to. */
static uint64_t room_elsewhere(const slc_manager *m, uint32_t source)
{
    uint64_t room = 0;
    for (uint32_t i = 0; i < m->heaps.end; i++)
        if (i != source && m->heaps.heaps[i].free_count != SLC_HEAP_DEAD &&
            live_slots(m, i) >= live_slots(m, source))
            room += m->heaps.heaps[i].free_count;
    return room;
}

static bool can_be_emptied(const slc_manager *m, uint32_t heap)
{
    const struct slc_tile_heap *h = &m->heaps.heaps[heap];
    uint32_t live = h->free_count == SLC_HEAP_DEAD ? 0 : live_slots(m, heap);
    if (live == 0 || room_elsewhere(m, heap) < live)
        return false;
    for (uint32_t slot = 0; slot < m->heaps.capacity; slot++)
        if (h->nodes[slot] && !is_movable(m, h->nodes[slot]))
            return false;
    return true;
}

/** The least used heap that can be emptied, of equals the last one; SLC_NONE if there is none. */
static uint32_t find_source(const slc_manager *m)
{
    uint32_t best = SLC_NONE;
    for (uint32_t i = 0; i < m->heaps.end; i++)
        if (can_be_emptied(m, i) && (best == SLC_NONE || live_slots(m, i) <= live_slots(m, best)))
            best = i;
    return best;
}

/** The fullest heap with room that is at least as full as the source. */
static uint32_t find_destination(const slc_manager *m, uint32_t source)
{
    uint32_t best = SLC_NONE;
    for (uint32_t i = 0; i < m->heaps.end; i++) {
        const struct slc_tile_heap *h = &m->heaps.heaps[i];
        if (i == source || h->free_count == SLC_HEAP_DEAD || h->free_count == 0 ||
            live_slots(m, i) < live_slots(m, source))
            continue;
        if (best == SLC_NONE || h->free_count < m->heaps.heaps[best].free_count)
            best = i;
    }
    return best;
}

static void leave_slot(slc_manager *m, uint32_t heap, uint32_t slot, uint64_t retire_value)
{
    if (retire_value <= m->completed_retire)
        slc_tile_heaps_give(&m->heaps, heap, slot);
    else
        slc_node_retire_slot(m, heap, slot, retire_value);
}

static void move_tile(slc_manager *m, uint32_t node, uint32_t destination, uint64_t retire_value,
                      SluiceTileMove *move)
{
    struct slc_node *n = slc_node_at(m, node);
    uint32_t heap = n->heap, slot = n->slot;
    move->from = slc_node_tile(m, node);
    n->slot = slc_tile_heaps_take_from(&m->heaps, destination, node);
    n->heap = destination;
    move->heapId = m->heaps.heaps[destination].id;
    move->slot = n->slot;
    leave_slot(m, heap, slot, retire_value);
    m->moved_total++;
}

/** Moves tiles out of `source` while there is room in `moves`. Returns how many. */
static uint32_t empty_heap(slc_manager *m, uint32_t source, uint64_t retire_value, uint32_t room,
                           SluiceTileMove *moves)
{
    uint32_t count = 0;
    for (uint32_t slot = 0; slot < m->heaps.capacity && count < room; slot++) {
        uint32_t node = m->heaps.heaps[source].nodes[slot];
        if (!node || slc_node_at(m, node)->state == SLC_NODE_RETIRING)
            continue;
        uint32_t destination = find_destination(m, source);
        assert(destination != SLC_NONE); /* can_be_emptied counted the room */
        move_tile(m, node, destination, retire_value, &moves[count++]);
    }
    return count;
}

static SluiceResult defragment(slc_manager *m, uint64_t retire_value, uint32_t *count,
                               SluiceTileMove *moves)
{
    if (slc_retire_is_backwards(m, retire_value))
        return SLUICE_ERROR_TIME_BACKWARDS;
    uint32_t room = *count, written = 0;
    /* One node per move stays behind. A heap that was emptied is not filled again in the same call,
     * so no tile moves more often than there are heaps. */
    uint64_t movable = (uint64_t)m->state_counts[SLUICE_TILE_STATE_MAPPED] +
                       m->state_counts[SLUICE_TILE_STATE_STANDBY];
    uint64_t most = movable * m->heaps.live_count;
    if (!slc_reserve_nodes(m, most < room ? most : room))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (retire_value)
        m->last_retire = retire_value;
    while (written < room) {
        uint32_t source = find_source(m);
        if (source == SLC_NONE)
            break;
        written += empty_heap(m, source, retire_value, room - written, moves + written);
    }
    *count = written;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceDefragmentTiles(SluiceStreamedTextureManager *manager, uint64_t retireValue,
                                   uint32_t *pMoveCount, SluiceTileMove *pMoves)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {
        .kind = SLC_CALL_DEFRAGMENT, .retire_value = retireValue, .moves = pMoves};
    if (!pMoveCount || !pMoves) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        call.room = *pMoveCount;
        call.result = defragment(manager, retireValue, pMoveCount, pMoves);
        call.count = *pMoveCount;
    }
    slc_notify(manager, &call);
    return call.result;
}
