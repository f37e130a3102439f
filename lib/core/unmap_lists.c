/* Lists of tiles to unmap and to cancel. */
#include "core/clock.h"
#include "core/history.h"
#include "core/list_call.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "core/texture_tiles.h"
#include "residency/node.h"
#include "residency/node_list.h"

static bool in_scope(const slc_manager *m, const struct slc_managed_texture *scope, uint32_t node)
{
    return !scope || slc_node_at(&m->residency, node)->owner == scope->index;
}

static uint32_t count_in_scope(const slc_manager *m, const struct slc_list *list,
                               const struct slc_managed_texture *scope)
{
    if (!scope)
        return list->count;
    uint32_t count = 0;
    for (uint32_t node = list->head; node; node = slc_node_at(&m->residency, node)->next)
        count += in_scope(m, scope, node);
    return count;
}

/** Takes a node from a list. False, with nothing changed, without host memory. */
typedef bool (*take_function)(slc_manager *m, uint32_t node, uint64_t retire_value);

/** Hands out the tiles of a list that are in scope, from the head on. */
static SluiceResult take_list(slc_manager *m, struct slc_list *list,
                              const struct slc_managed_texture *scope, uint64_t retire_value,
                              take_function take, uint32_t *count, SluiceTile *tiles)
{
    if (!tiles) {
        *count = count_in_scope(m, list, scope);
        return SLUICE_SUCCESS;
    }
    uint32_t room = *count, written = 0;
    uint32_t node = list->head;
    while (node) {
        uint32_t next = slc_node_at(&m->residency, node)->next;
        if (in_scope(m, scope, node)) {
            if (written == room)
                break;
            tiles[written] = slc_node_tile(m, node);
            if (!take(m, node, retire_value)) {
                m->cut_short = true;
                break;
            }
            written++;
        }
        node = next;
    }
    if (m->cut_short && written == 0)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *count = written;
    return node ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

static bool take_unmapped(slc_manager *m, uint32_t node, uint64_t retire_value)
{
    struct slc_managed_texture *t = slc_texture_at(m, slc_node_at(&m->residency, node)->owner);
    m->events.reason = SLUICE_TILE_EVENT_UNMAPPED;
    if (!(slc_node_at(&m->residency, node)->flags & SLC_NODE_WANTED))
        slc_node_retire(&m->residency, node, retire_value);
    else if (!slc_node_unmap_wanted(&m->residency, node, retire_value))
        return false;
    slc_state_release(m, t);
    m->unmapped_total++;
    t->unmapped_total++;
    return true;
}

static bool take_canceled(slc_manager *m, uint32_t node, uint64_t retire_value)
{
    (void)retire_value;
    slc_list_remove(&m->residency, &m->residency.canceled, node);
    slc_node_at(&m->residency, node)->flags |= SLC_NODE_LISTED;
    return true;
}

static SluiceResult get_tiles_to_unmap(slc_manager *m, struct slc_managed_texture *scope,
                                       const struct slc_list_call *call)
{
    if (slc_retire_is_backwards(m, call->retire_value))
        return SLUICE_ERROR_TIME_BACKWARDS;
    SluiceResult result = take_list(m, &m->residency.evicted, scope, call->retire_value,
                                    take_unmapped, call->count, call->tiles);
    if (call->tiles && call->retire_value && result >= SLUICE_SUCCESS)
        m->last_retire = call->retire_value;
    return result;
}

static SluiceResult get_tiles_to_cancel(slc_manager *m, struct slc_managed_texture *scope,
                                        const struct slc_list_call *call)
{
    return take_list(m, &m->residency.canceled, scope, 0, take_canceled, call->count, call->tiles);
}

SluiceResult sluiceGetTilesToUnmap(SluiceStreamedTextureManager *manager, SluiceTextureId textureId,
                                   uint64_t retireValue, uint32_t *pTileCount, SluiceTile *pTiles)
{
    const struct slc_list_call call = {
        __func__, SLC_CALL_GET_TILES_TO_UNMAP, textureId, retireValue, pTileCount, pTiles};
    return slc_list_call_make(manager, &call, get_tiles_to_unmap);
}

SluiceResult sluiceGetTilesToCancel(SluiceStreamedTextureManager *manager,
                                    SluiceTextureId textureId, uint32_t *pTileCount,
                                    SluiceTile *pTiles)
{
    const struct slc_list_call call = {
        __func__, SLC_CALL_GET_TILES_TO_CANCEL, textureId, 0, pTileCount, pTiles};
    return slc_list_call_make(manager, &call, get_tiles_to_cancel);
}

SluiceResult sluiceCompleteRetireValue(SluiceStreamedTextureManager *manager, uint64_t retireValue)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_COMPLETE_RETIRE, .retire_value = retireValue};
    if (retireValue < manager->residency.completed_retire && retireValue != 0) {
        call.result = SLUICE_ERROR_TIME_BACKWARDS;
    } else if (retireValue != 0) {
        manager->residency.completed_retire = retireValue;
        slc_collect_retired(&manager->residency);
    }
    slc_notify(manager, &call);
    return call.result;
}
