/* Answers to tiles that were handed out. */
#include "core/naive_manager.h"

#include <stdlib.h>

static bool accepts(const struct naive_tile *tile)
{
    return tile->state == SLUICE_TILE_STATE_ALLOCATED || tile->state == SLUICE_TILE_STATE_CANCELED;
}

static SluiceResult check_tiles(const struct naive_texture *t, const struct call *call)
{
    for (uint32_t i = 0; i < call->count; i++) {
        if (call->indices[i] >= t->layout.tileCount)
            return SLUICE_ERROR_UNKNOWN_TILE;
        if (!accepts(&t->tiles[call->indices[i]]))
            return SLUICE_ERROR_INVALID_TILE_STATE;
        for (uint32_t k = 0; k < i; k++)
            if (call->indices[k] == call->indices[i])
                return SLUICE_ERROR_INVALID_TILE_STATE;
    }
    return SLUICE_SUCCESS;
}

static void answer_mapped(struct naive_manager *n, struct naive_texture *t, struct naive_tile *tile)
{
    naive_note_success(n, t, tile->failures > 0);
    tile->failures = 0;
    t->minmip_stale = true;
    n->totals.mappedTotal++;
    if (tile->wanted) {
        naive_become_mapped(n, tile);
        return;
    }
    naive_stand_by(n, tile);
}

static uint64_t retry_delay(uint64_t delay, uint32_t failures)
{
    const uint64_t most = (uint64_t)1 << 62;
    for (uint32_t i = 1; i < failures && delay < most; i++)
        delay *= 2;
    return delay < most ? delay : most;
}

static void answer_failed(struct naive_manager *n, struct naive_texture *t, struct naive_tile *tile,
                          uint64_t time)
{
    naive_free_slot(n, tile);
    n->totals.failedTotal++;
    if (!tile->wanted) {
        tile->failures = 0;
        tile->state = SLUICE_TILE_STATE_FREE;
        return;
    }
    uint32_t most = n->config.maxLoadAttempts ? n->config.maxLoadAttempts : 5;
    if (++tile->failures < most) {
        tile->state = SLUICE_TILE_STATE_FAILED;
        tile->due = time + retry_delay(n->config.retryDelayTicks, tile->failures);
        tile->failed_at = ++n->stamp;
        return;
    }
    tile->state = SLUICE_TILE_STATE_GIVEN_UP;
    tile->given_up_at = ++n->stamp;
    naive_note_given_up(n, t);
    for (uint32_t i = 0; i < n->given_up_count; i++)
        if (n->given_up[i].texture == t->id && n->given_up[i].tile == (uint32_t)(tile - t->tiles))
            return; /* it is in the list */
    n->given_up = realloc(n->given_up, (n->given_up_count + 1) * sizeof *n->given_up);
    if (!n->given_up)
        abort();
    n->given_up[n->given_up_count++] = (struct naive_given_up){t->id, (uint32_t)(tile - t->tiles)};
}

static void answer_canceled(struct naive_manager *n, struct naive_tile *tile, uint64_t retire)
{
    naive_retire_slot(n, tile, retire);
    n->totals.canceledTotal++;
    if (tile->wanted)
        naive_request(n, tile, 0);
    else
        tile->state = SLUICE_TILE_STATE_FREE;
}

SluiceResult naive_answer(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    result = check_tiles(t, call);
    if (result != SLUICE_SUCCESS)
        return result;
    if (call->kind == CALL_FAILED) {
        if (n->has_time && (int64_t)(call->time - n->time) < 0)
            return SLUICE_ERROR_TIME_BACKWARDS;
        n->has_time = true;
        n->time = call->time;
        naive_retry_due(n, call->time);
    }
    if (call->kind == CALL_CANCELED) {
        if (call->retire != 0 && call->retire < n->last_retire)
            return SLUICE_ERROR_TIME_BACKWARDS;
        if (call->retire != 0)
            n->last_retire = call->retire;
    }
    for (uint32_t i = 0; i < call->count; i++) {
        struct naive_tile *tile = &t->tiles[call->indices[i]];
        switch (call->kind) {
        case CALL_MAPPED: answer_mapped(n, t, tile); break;
        case CALL_FAILED: answer_failed(n, t, tile, call->time); break;
        case CALL_CANCELED: answer_canceled(n, tile, call->retire); break;
        default: abort();
        }
    }
    naive_update_minmip(n, t);
    return SLUICE_SUCCESS;
}
