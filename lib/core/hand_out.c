/* Hand-out: chooses the requested tiles to load next, and their slots. */
#include "base/alloc.h"
#include "base/bits.h"
#include "core/mip_bias.h"
#include "core/eviction.h"
#include "core/history.h"
#include "core/list_call.h"
#include "core/observer.h"
#include "core/prefetch.h"
#include "core/request_walk.h"
#include "core/rounds.h"
#include "core/texture_tiles.h"
#include "residency/node.h"

static bool may_add_heap(const slc_manager *m)
{
    uint32_t most = m->config.maxHeapCount, target = m->config.targetHeapCount;
    uint32_t count = m->residency.heaps.live_count;
    return (!most || count < most) && (!target || count < target);
}

/**
 * Number of slots that a call for one texture leaves to coarser requests of other textures, if no
 * heap can be added. Otherwise the texture that is listed first would take their slots.
 */
static uint64_t owed_slots(const slc_manager *m, uint32_t level)
{
    uint64_t owed = 0;
    if (!m->refused && may_add_heap(m))
        return 0;
    for (uint32_t l = level + 1; l < SLUICE_MAX_MIP_LEVELS; l++)
        owed += m->residency.requests.counts[l];
    return owed;
}

/** Takes a slot from a new heap. BUDGET_REACHED if no heap can be added. */
static SluiceResult take_from_new_heap(slc_manager *m, struct slc_node *n, uint32_t node,
                                       bool separate, bool *refused)
{
    if (*refused || !may_add_heap(m))
        return SLUICE_BUDGET_REACHED;
    struct slc_call call = {.kind = SLC_CALL_HEAP_ANSWER};
    SluiceResult result = slc_tile_heaps_add(&m->residency.heaps, &call.result, &call.heap_id);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return result;
    slc_notify(m, &call);
    *refused = m->refused = result != SLUICE_SUCCESS;
    if (*refused)
        return SLUICE_BUDGET_REACHED;
    if (separate)
        slc_tile_heaps_take_packed(&m->residency.heaps, node, &n->heap, &n->slot);
    else
        slc_tile_heaps_take(&m->residency.heaps, node, &n->heap, &n->slot);
    return SLUICE_SUCCESS;
}

/** Takes a free slot for the node, from a new heap if need be. The last free slots are kept for
 *  packed tiles. Slots in heaps of the other kind are taken last. */
static SluiceResult take_slot(slc_manager *m, const struct slc_managed_texture *scope,
                              uint32_t node, bool *refused)
{
    struct slc_node *n = slc_node_at(&m->residency, node);
    struct slc_tile_heaps *heaps = &m->residency.heaps;
    if (n->level == SLC_OUTSIDE_CLASS)
        return SLUICE_SUCCESS;
    bool packed = n->level == SLC_PACKED_CLASS;
    bool separate = packed && m->config.separatePackedTiles;
    uint64_t kept = slc_kept_slots(m) + (scope ? owed_slots(m, n->level) : 0);
    bool may_take = packed || heaps->free_total > kept;
    bool taken;
    if (separate)
        taken = slc_tile_heaps_take_packed(heaps, node, &n->heap, &n->slot);
    else if (heaps->packed_free) /* rare, so kept out of the way */
        taken = may_take && slc_has_own_slot(m) && slc_take_own_slot(m, node);
    else
        taken = may_take && slc_tile_heaps_take(heaps, node, &n->heap, &n->slot);
    if (taken)
        return SLUICE_SUCCESS;
    SluiceResult result = take_from_new_heap(m, n, node, separate, refused);
    if (result == SLUICE_BUDGET_REACHED && may_take &&
        slc_tile_heaps_take(heaps, node, &n->heap, &n->slot))
        return SLUICE_SUCCESS;
    /* Settle only after the answer, because a failed call must keep the order of equal heaps. */
    if (result == SLUICE_BUDGET_REACHED && packed)
        slc_tile_heaps_settle(heaps);
    return result;
}

static uint32_t requests_in_scope(const slc_manager *m, const struct slc_managed_texture *scope)
{
    return scope ? scope->requested_count : m->residency.requests.count;
}

/** Prefetches the memory of the next requests. */
static void prefetch_request(const slc_manager *m, uint32_t node)
{
    if (!node)
        return;
    const struct slc_node *n = slc_node_at(&m->residency, node);
    const struct slc_managed_texture *t = slc_texture_at(m, n->owner);
    SLC_PREFETCH(t);
    if (!slc_is_packed_class(n->level))
        SLC_PREFETCH(&t->shape->levels[n->level]);
    SLC_PREFETCH(slc_node_at(&m->residency, n->next));
}

static SluiceResult hand_out(slc_manager *m, const struct slc_managed_texture *scope,
                             const struct slc_request_key *keys, uint32_t *count, SluiceTile *tiles)
{
    uint32_t room = *count, written = 0, passed_over = 0;
    uint64_t limit = slc_slot_limit(m);
    bool refused = false;
    SluiceResult result = SLUICE_SUCCESS;
    m->events.reason = SLUICE_TILE_EVENT_LISTED;
    struct slc_request_walk walk = slc_walk_requests(m, scope, keys);
    while (written < room && walk.node && passed_over < SLC_MAX_PASSED_OVER) {
        uint32_t node = walk.node;
        if (m->starved && !slc_is_asked_for(m, node)) {
            slc_walk_on(m, &walk);
            passed_over++;
            continue;
        }
        result = take_slot(m, scope, node, &refused);
        if (result != SLUICE_SUCCESS)
            break;
        slc_walk_on(m, &walk);
        prefetch_request(m, walk.node);
        slc_node_handed_out(&m->residency, node);
        tiles[written++] = slc_node_tile(m, node);
    }
    if (!scope && m->residency.requests.count == 0 && m->config.prefetchLevels &&
        result == SLUICE_SUCCESS)
        result = slc_prefetch(m, room, &written, tiles);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY && written == 0)
        return result;
    slc_end_round(&m->round, m->visited_count, m->residency.requests.next_sequence);
    slc_update_bias(m, limit); /* not earlier: a failing call must change nothing */
    m->handed_out_total += written;
    *count = written;
    uint32_t left = requests_in_scope(m, scope);
    if (room > 0)
        m->starved = result == SLUICE_BUDGET_REACHED;
    /* Whatever the room in `tiles`: evicted slots become free only in later calls. */
    bool evicts = result == SLUICE_BUDGET_REACHED && !m->config.noEviction;
    if (evicts || slc_surplus_slots(m)) {
        if (!slc_evict_unwanted_for(m, evicts ? left : 0))
            slc_evict_wanted_for(m, walk, evicts ? left : 0);
    }
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY) {
        result = SLUICE_SUCCESS; /* keeps the tiles handed out; the next call fails first */
        m->cut_short = true;
    }
    return result == SLUICE_SUCCESS && left > 0 ? SLUICE_INCOMPLETE : result;
}

static SluiceResult get_tiles_to_map(slc_manager *m, struct slc_managed_texture *scope,
                                     const struct slc_list_call *call)
{
    uint32_t requests = requests_in_scope(m, scope);
    if (!call->tiles) {
        *call->count = requests;
        return SLUICE_SUCCESS;
    }
    if (!scope || requests == 0)
        return hand_out(m, scope, NULL, call->count, call->tiles);
    struct slc_request_key *keys = slc_sort_requests(m, scope);
    if (!keys)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = hand_out(m, scope, keys, call->count, call->tiles);
    slc_free(&m->cb, keys, requests, sizeof *keys);
    return result;
}

SluiceResult sluiceGetTilesToMap(SluiceStreamedTextureManager *manager, SluiceTextureId textureId,
                                 uint32_t *pTileCount, SluiceTile *pTiles)
{
    const struct slc_list_call call = {
        __func__, SLC_CALL_GET_TILES_TO_MAP, textureId, 0, pTileCount, pTiles};
    return slc_list_call_make(manager, &call, get_tiles_to_map);
}
