/* Rules for moves. The manager chooses the moves; these checks accept any choice that follows the
 * rules. */
#include "core/naive_manager.h"

/* Returns the living tile that a move names, if it is at the named position. Otherwise complains
 * and returns NULL. */
static struct naive_tile *moved_tile(struct naive_manager *n, const SluiceTileMove *m, uint32_t i)
{
    SluiceResult result;
    struct naive_texture *t = naive_find(n, m->from.textureId, &result);
    if (!t || m->from.tileIndex >= t->layout.tileCount) {
        naive_complain(n, "move %u is of no tile", i);
        return NULL;
    }
    struct naive_tile *tile = &t->tiles[m->from.tileIndex];
    if (tile->state != SLUICE_TILE_STATE_MAPPED && tile->state != SLUICE_TILE_STATE_STANDBY)
        naive_complain(n, "move %u: the tile is in state %d", i, (int)tile->state);
    else if (tile->heap != m->from.heapId || tile->slot != m->from.slot)
        naive_complain(n, "move %u: the tile is not in slot %u of heap %u", i, m->from.slot,
                       m->from.heapId);
    return n->complaint[0] ? NULL : tile;
}

static void make_move(struct naive_manager *n, const struct call *call, const SluiceTileMove *m,
                      uint32_t i)
{
    struct naive_tile *tile = moved_tile(n, m, i);
    struct naive_heap *to = naive_find_heap(n, m->heapId);
    if (!tile)
        return;
    if (!to || m->slot >= n->capacity || to->slots[m->slot].use != NAIVE_SLOT_FREE) {
        naive_complain(n, "move %u: slot %u of heap %u is not free", i, m->slot, m->heapId);
        return;
    }
    const struct naive_heap *from = naive_find_heap(n, tile->heap);
    if (from == to ||
        naive_count_slots(n, from, NAIVE_SLOT_USED) > naive_count_slots(n, to, NAIVE_SLOT_USED))
        naive_complain(n, "move %u leads from heap %u to %u, which is not fuller", i, from->id,
                       to->id);
    naive_retire_slot(n, tile, call->retire);
    to->slots[m->slot].use = NAIVE_SLOT_USED;
    tile->heap = m->heapId;
    tile->slot = m->slot;
    n->totals.movedTotal++;
}

/* Checks moves that had room for all: each must help to empty a heap. */
static void check_sources_are_empty(struct naive_manager *n, const struct outcome *seen)
{
    for (uint32_t i = 0; i < seen->count; i++) {
        const struct naive_heap *heap = naive_find_heap(n, seen->moves[i].from.heapId);
        if (heap && naive_count_slots(n, heap, NAIVE_SLOT_USED) > 0)
            naive_complain(n, "move %u leaves heap %u, in which other tiles stay", i, heap->id);
    }
}

/* Returns whether all tiles of the heap could move to heaps that are at least as full. For
 * evacuation: to heaps for packed tiles. */
static bool could_be_emptied(const struct naive_manager *n, const struct naive_heap *heap,
                             bool evicts)
{
    const uint32_t used = naive_count_slots(n, heap, NAIVE_SLOT_USED);
    uint64_t room = 0;
    uint32_t movable = 0;
    for (uint32_t i = 0; i < n->heap_count; i++) {
        const uint32_t there = naive_count_slots(n, &n->heaps[i], NAIVE_SLOT_USED);
        if (&n->heaps[i] != heap && (there >= used || (evicts && there && n->heaps[i].packed)))
            room += naive_count_slots(n, &n->heaps[i], NAIVE_SLOT_FREE);
    }
    for (uint32_t i = 0; i < n->texture_room; i++)
        for (uint32_t k = 0; n->textures[i] && k < n->textures[i]->layout.tileCount; k++) {
            const struct naive_tile *tile = &n->textures[i]->tiles[k];
            movable += naive_has_slot(tile) && tile->heap == heap->id &&
                       (tile->state == SLUICE_TILE_STATE_MAPPED ||
                        tile->state == SLUICE_TILE_STATE_STANDBY);
        }
    return used > 0 && movable == used && room >= used;
}

static struct naive_tile *tile_in(const struct naive_manager *n, const struct naive_heap *heap,
                                  uint32_t slot)
{
    for (uint32_t i = 0; i < n->texture_room; i++)
        for (uint32_t k = 0; n->textures[i] && k < n->textures[i]->layout.tileCount; k++) {
            struct naive_tile *tile = &n->textures[i]->tiles[k];
            if (naive_has_slot(tile) && tile->heap == heap->id && tile->slot == slot)
                return tile;
        }
    return NULL;
}

static bool has_packed_tile(const struct naive_manager *n, const struct naive_heap *heap)
{
    for (uint32_t slot = 0; slot < n->capacity; slot++) {
        const struct naive_tile *tile = tile_in(n, heap, slot);
        if (tile && tile->packed)
            return true;
    }
    return false;
}

/* Returns the heap with the fewest tiles, the last among equals. NULL: none can be evacuated. */
static const struct naive_heap *heap_to_evacuate(const struct naive_manager *n)
{
    const struct naive_heap *best = NULL;
    uint32_t fewest = UINT32_MAX;
    for (uint32_t i = 0; i < n->heap_count; i++) {
        const struct naive_heap *heap = &n->heaps[i];
        const uint32_t used = naive_count_slots(n, heap, NAIVE_SLOT_USED);
        if (used > fewest || (best && used == fewest && heap->number < best->number) ||
            !could_be_emptied(n, heap, true) || has_packed_tile(n, heap))
            continue;
        best = heap;
        fewest = used;
    }
    return best;
}

SluiceResult naive_evacuate(struct naive_manager *n, const struct call *call)
{
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    const struct naive_heap *heap = heap_to_evacuate(n);
    uint32_t left = call->keep;
    for (uint32_t slot = 0; heap && slot < n->capacity && left > 0; slot++) {
        struct naive_tile *tile = tile_in(n, heap, slot);
        if (!tile || tile->listed)
            continue;
        if (tile->state == SLUICE_TILE_STATE_MAPPED) {
            naive_evict(n, tile);
        } else {
            tile->listed = true;
            tile->listed_at = ++n->stamp;
        }
        n->events[NAIVE_EVACUATED]++;
        left--;
    }
    return SLUICE_SUCCESS;
}

SluiceResult naive_defragment(struct naive_manager *n, const struct call *call,
                              const struct outcome *seen, struct outcome *out)
{
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    if (call->retire != 0 && call->retire < n->last_retire)
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (call->retire)
        n->last_retire = call->retire;
    for (uint32_t i = 0; i < seen->count && !n->complaint[0]; i++) {
        SluiceResult result;
        const SluiceTile *from = &seen->moves[i].from;
        const struct naive_texture *t = naive_find(n, from->textureId, &result);
        out->moves[i] = seen->moves[i];
        if (t && from->tileIndex < t->layout.tileCount)
            out->moves[i].from = naive_tile_info(t, from->tileIndex);
        make_move(n, call, &seen->moves[i], i);
    }
    out->count = seen->count;
    if (seen->count < call->room) { /* no move is left */
        check_sources_are_empty(n, seen);
        for (uint32_t i = 0; i < n->heap_count; i++)
            if (could_be_emptied(n, &n->heaps[i], false))
                naive_complain(n, "heap %u could be emptied", n->heaps[i].id);
    }
    return out->count > call->room ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_SUCCESS;
}
