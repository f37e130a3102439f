/* Moves of tiles that empty heaps. */
#include "core/clock.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "core/texture_tiles.h"
#include "residency/defragment.h"

/** Array that moves are written to. */
struct moves {
    slc_manager *manager;
    uint32_t count;
    SluiceTileMove *list;
};

static void write_move(void *user, const struct slc_node *n, uint32_t heap_id, uint32_t slot)
{
    struct moves *moves = user;
    slc_manager *m = moves->manager;
    SluiceTile from = slc_node_tile(m, m->residency.heaps.heaps[n->heap].nodes[n->slot]);
    SluiceTileMove move = {.from = from, .heapId = from.heapId, .slot = from.slot};
    move.from.heapId = heap_id;
    move.from.slot = slot;
    moves->list[moves->count++] = move;
    m->moved_total++;
}

static SluiceResult defragment(slc_manager *m, uint64_t retire_value, uint32_t *count,
                               SluiceTileMove *list)
{
    if (slc_retire_is_backwards(m, retire_value))
        return SLUICE_ERROR_TIME_BACKWARDS;
    struct moves moves = {.manager = m, .list = list};
    struct slc_move_listener listener = {&moves, write_move};
    SluiceResult result = slc_defragment(&m->residency, retire_value, *count, &listener);
    if (result != SLUICE_SUCCESS)
        return result;
    if (retire_value)
        m->last_retire = retire_value;
    *count = moves.count;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceDefragmentTiles(SluiceStreamedTextureManager *manager, uint64_t retireValue,
                                   uint32_t *pMoveCount, SluiceTileMove *pMoves)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
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
