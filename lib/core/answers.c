/* Answers of the application to tiles that were handed out: mapped, failed, or canceled. */
#include "base/alloc.h"
#include "base/bits.h"
#include "base/checked.h"
#include "core/clock.h"
#include "core/given_up_retry.h"
#include "core/history.h"
#include "core/lookup.h"
#include "core/minmip.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "core/reports.h"
#include "core/texture_tiles.h"
#include "residency/due.h"
#include "residency/node.h"
#include "residency/nodes.h"

/** Marks a node while an answer is checked, so that a tile listed twice is found. */
#define NODE_SEEN 128

/** Least number of tiles in a call for which prefetching the memory of all pays off. */
#define MANY 4

static bool is_in_flight(const struct slc_node *n)
{
    return n->state == SLUICE_TILE_STATE_ALLOCATED || n->state == SLUICE_TILE_STATE_CANCELED;
}

/** Marks a tile. Fails if it was not handed out, or is marked already. */
static SluiceResult mark_tile(slc_manager *m, const struct slc_managed_texture *t, uint32_t tile)
{
    if (tile >= t->shape->tile_count)
        return SLUICE_ERROR_UNKNOWN_TILE;
    uint32_t node = slc_find_node(t, tile);
    if (!node)
        return SLUICE_ERROR_INVALID_TILE_STATE;
    struct slc_node *n = slc_node_at(&m->residency, node);
    if (!is_in_flight(n) || n->flags & NODE_SEEN)
        return SLUICE_ERROR_INVALID_TILE_STATE;
    n->flags |= NODE_SEEN;
    return SLUICE_SUCCESS;
}

static void unmark_tiles(slc_manager *m, const struct slc_managed_texture *t, uint32_t count,
                         const uint32_t *tiles)
{
    for (uint32_t i = 0; i < count; i++)
        slc_node_at(&m->residency, slc_find_node(t, tiles[i]))->flags &= (uint8_t)~NODE_SEEN;
}

/**
 * Checks that all tiles were handed out and are listed once, and marks them. Marks end when the
 * states change. After an error no tile is marked.
 */
static SluiceResult check_tiles(slc_manager *m, const struct slc_managed_texture *t, uint32_t count,
                                const uint32_t *tiles)
{
    bool many = count >= MANY;
    for (uint32_t i = 0; many && i < count; i++)
        if (tiles[i] < t->shape->tile_count)
            SLC_PREFETCH(slc_node_at(&m->residency, slc_find_node(t, tiles[i])));
    for (uint32_t i = 0; i < count; i++) {
        SluiceResult result = mark_tile(m, t, tiles[i]);
        if (many && result == SLUICE_SUCCESS)
            slc_min_mip_prefetch(t, slc_node_at(&m->residency, slc_find_node(t, tiles[i])));
        if (result == SLUICE_SUCCESS)
            continue;
        unmark_tiles(m, t, i, tiles);
        return result;
    }
    return SLUICE_SUCCESS;
}

static SluiceResult check_answer(slc_manager *m, SluiceTextureId id, uint32_t count,
                                 const uint32_t *tiles, struct slc_managed_texture **t)
{
    if (count > 0 && !tiles)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_find_texture(m, id, t);
    return result == SLUICE_SUCCESS ? check_tiles(m, *t, count, tiles) : result;
}

static bool is_wanted(const struct slc_node *n)
{
    return n->state == SLUICE_TILE_STATE_ALLOCATED || n->flags & SLC_NODE_WANTED;
}

static void answer_mapped(slc_manager *m, struct slc_managed_texture *t, uint32_t node)
{
    struct slc_node *n = slc_node_at(&m->residency, node);
    if (t->given_up_first)
        slc_given_up_note_success(m, t, n->failures > 0);
    n->failures = 0;
    m->events.reason = SLUICE_TILE_EVENT_ANSWERED;
    if (n->state == SLUICE_TILE_STATE_ALLOCATED)
        slc_node_mapped(&m->residency, node);
    else
        slc_node_set_state(&m->residency, node,
                           is_wanted(n) ? SLUICE_TILE_STATE_MAPPED : SLUICE_TILE_STATE_STANDBY);
    m->mapped_total++;
    t->mapped_total++;
}

static void answer_failed(slc_manager *m, uint32_t node, uint64_t time)
{
    m->failed_total++;
    m->events.reason = SLUICE_TILE_EVENT_ANSWERED;
    slc_texture_at(m, slc_node_at(&m->residency, node)->owner)->failed_total++;
    slc_node_free_slot(&m->residency, node);
    if (!is_wanted(slc_node_at(&m->residency, node))) {
        slc_node_release(&m->residency, node);
        return;
    }
    slc_node_fail(&m->residency, node, time);
    const struct slc_node *n = slc_node_at(&m->residency, node);
    if (n->state != SLUICE_TILE_STATE_GIVEN_UP)
        return;
    slc_given_up_again(m, slc_texture_at(m, n->owner));
    slc_reports_add(m, slc_texture_at(m, n->owner), n->tile);
}

/** Retires the slot. A wanted tile gets a new node, which the caller has reserved. */
static void answer_canceled(slc_manager *m, uint32_t node, uint64_t retire_value)
{
    bool wanted = is_wanted(slc_node_at(&m->residency, node));
    uint32_t tile = slc_node_at(&m->residency, node)->tile,
             level = slc_node_at(&m->residency, node)->level;
    uint32_t failures = slc_node_at(&m->residency, node)->failures;
    struct slc_managed_texture *t = slc_texture_at(m, slc_node_at(&m->residency, node)->owner);
    m->events.reason = SLUICE_TILE_EVENT_ANSWERED;
    slc_node_retire(&m->residency, node, retire_value);
    m->canceled_total++;
    if (!wanted)
        return;
    slc_tile_wanted(m, t, slc_node_cell(t, tile), tile, level);
    slc_node_at(&m->residency, slc_find_node(t, tile))->failures = failures;
}

static SluiceResult update_mapping(slc_manager *m, SluiceTextureId id, uint32_t count,
                                   const uint32_t *tiles)
{
    struct slc_managed_texture *t;
    SluiceResult result = check_answer(m, id, count, tiles, &t);
    for (uint32_t i = 0; result == SLUICE_SUCCESS && i < count; i++)
        answer_mapped(m, t, slc_find_node(t, tiles[i]));
    return result;
}

static SluiceResult report_failed(slc_manager *m, SluiceTextureId id, uint32_t count,
                                  const uint32_t *tiles, uint64_t time)
{
    struct slc_managed_texture *t;
    SluiceResult result = check_answer(m, id, count, tiles, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_time_is_backwards(m, time))
        result = SLUICE_ERROR_TIME_BACKWARDS;
    else if (!slc_reports_reserve(m, count))
        result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result != SLUICE_SUCCESS) {
        unmark_tiles(m, t, count, tiles);
        return result;
    }
    slc_advance_time(m, time);
    for (uint32_t i = 0; i < count; i++)
        answer_failed(m, slc_find_node(t, tiles[i]), time);
    slc_state_release(m, t);
    return SLUICE_SUCCESS;
}

static SluiceResult report_canceled(slc_manager *m, SluiceTextureId id, uint32_t count,
                                    const uint32_t *tiles, uint64_t retire_value)
{
    struct slc_managed_texture *t;
    SluiceResult result = check_answer(m, id, count, tiles, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_retire_is_backwards(m, retire_value))
        result = SLUICE_ERROR_TIME_BACKWARDS;
    else if (!slc_reserve_nodes(&m->residency, count))
        result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result != SLUICE_SUCCESS) {
        unmark_tiles(m, t, count, tiles);
        return result;
    }
    if (retire_value)
        m->last_retire = retire_value;
    for (uint32_t i = 0; i < count; i++)
        answer_canceled(m, slc_find_node(t, tiles[i]), retire_value);
    slc_state_release(m, t);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceUpdateTilesMapping(SluiceStreamedTextureManager *manager,
                                      SluiceTextureId textureId, uint32_t tileCount,
                                      const uint32_t *pTileIndices)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_UPDATE_MAPPING,
                            .texture_id = textureId,
                            .count = tileCount,
                            .tile_indices = pTileIndices,
                            .result = update_mapping(manager, textureId, tileCount, pTileIndices)};
    slc_notify(manager, &call);
    return call.result;
}

SluiceResult sluiceReportFailedTiles(SluiceStreamedTextureManager *manager,
                                     SluiceTextureId textureId, uint32_t tileCount,
                                     const uint32_t *pTileIndices, uint64_t timeStamp)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {
        .kind = SLC_CALL_REPORT_FAILED,
        .texture_id = textureId,
        .count = tileCount,
        .tile_indices = pTileIndices,
        .time_stamp = timeStamp,
        .result = report_failed(manager, textureId, tileCount, pTileIndices, timeStamp)};
    slc_notify(manager, &call);
    return call.result;
}

SluiceResult sluiceReportCanceledTiles(SluiceStreamedTextureManager *manager,
                                       SluiceTextureId textureId, uint32_t tileCount,
                                       const uint32_t *pTileIndices, uint64_t retireValue)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {
        .kind = SLC_CALL_REPORT_CANCELED,
        .texture_id = textureId,
        .count = tileCount,
        .tile_indices = pTileIndices,
        .retire_value = retireValue,
        .result = report_canceled(manager, textureId, tileCount, pTileIndices, retireValue)};
    slc_notify(manager, &call);
    return call.result;
}

static void retry_failed(slc_manager *m, const struct slc_managed_texture *scope)
{
    for (uint32_t node = slc_due_first(&m->residency), next; node; node = next) {
        next = slc_due_next(&m->residency, node);
        if (!scope || slc_node_at(&m->residency, node)->owner == scope->index)
            slc_node_request_again(&m->residency, node);
    }
}

static void retry_given_up(slc_manager *m, const struct slc_managed_texture *scope)
{
    const uint32_t *first = scope ? &scope->given_up_first : &m->residency.given_up.head;
    while (*first) {
        slc_node_at(&m->residency, *first)->failures = 0;
        slc_node_request_again(&m->residency, *first);
    }
}

SluiceResult sluiceRetryFailedTiles(SluiceStreamedTextureManager *manager,
                                    SluiceTextureId textureId)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_managed_texture *scope;
    struct slc_call call = {.kind = SLC_CALL_RETRY_FAILED,
                            .texture_id = textureId,
                            .result = slc_find_scope(manager, __func__, textureId, &scope)};
    if (call.result == SLUICE_SUCCESS) {
        manager->events.reason = SLUICE_TILE_EVENT_RETRIED;
        retry_failed(manager, scope);
        retry_given_up(manager, scope);
    }
    slc_notify(manager, &call);
    return call.result;
}
