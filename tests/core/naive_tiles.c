/* State changes of a tile and its slot. */
#include "core/naive_manager.h"

#include <stdlib.h>

bool naive_has_slot(const struct naive_tile *tile)
{
    return !tile->outside &&
           (tile->state == SLUICE_TILE_STATE_ALLOCATED || tile->state == SLUICE_TILE_STATE_MAPPED ||
            tile->state == SLUICE_TILE_STATE_STANDBY || tile->state == SLUICE_TILE_STATE_CANCELED);
}

SluiceTile naive_tile_info(const struct naive_texture *t, uint32_t index)
{
    const struct naive_tile *tile = &t->tiles[index];
    return (SluiceTile){t->id,
                        index,
                        tile->level,
                        tile->x,
                        tile->y,
                        naive_has_slot(tile) ? tile->heap : 0,
                        naive_has_slot(tile) ? tile->slot : 0};
}

struct naive_ref *naive_collect(const struct naive_manager *n, const struct naive_texture *only,
                                SluiceTileState state, uint32_t *count)
{
    uint32_t room = 0;
    struct naive_ref *refs = NULL;
    *count = 0;
    for (uint32_t i = 0; i < n->texture_room; i++) {
        struct naive_texture *t = n->textures[i];
        if (!t || (only && t != only))
            continue;
        for (uint32_t k = 0; k < t->layout.tileCount; k++) {
            if (t->tiles[k].state != state)
                continue;
            if (*count == room) {
                room = room ? 2 * room : 64;
                refs = realloc(refs, room * sizeof *refs);
                if (!refs)
                    abort();
            }
            refs[(*count)++] = (struct naive_ref){t, &t->tiles[k], {0}};
        }
    }
    return refs;
}

static int compare_refs(const void *a, const void *b)
{
    const struct naive_ref *x = a, *y = b;
    for (int i = 0; i < 4; i++)
        if (x->key[i] != y->key[i])
            return x->key[i] < y->key[i] ? -1 : 1;
    return 0;
}

void naive_sort(struct naive_ref *refs, uint32_t count)
{
    if (count > 1)
        qsort(refs, count, sizeof *refs, compare_refs);
}

static struct naive_slot *slot_of(struct naive_manager *n, const struct naive_tile *tile)
{
    return &naive_find_heap(n, tile->heap)->slots[tile->slot];
}

void naive_free_slot(struct naive_manager *n, struct naive_tile *tile)
{
    if (!tile->outside)
        slot_of(n, tile)->use = NAIVE_SLOT_FREE;
}

void naive_retire_slot(struct naive_manager *n, struct naive_tile *tile, uint64_t retire)
{
    bool over = retire <= n->completed;
    if (tile->outside)
        return;
    *slot_of(n, tile) =
        (struct naive_slot){over ? NAIVE_SLOT_FREE : NAIVE_SLOT_RETIRING, over ? 0 : retire};
}

void naive_request(struct naive_manager *n, struct naive_tile *tile, uint32_t need)
{
    tile->state = SLUICE_TILE_STATE_REQUESTED;
    tile->requested_at = ++n->stamp;
    tile->need = need;
}

void naive_become_mapped(struct naive_manager *n, struct naive_tile *tile)
{
    tile->state = SLUICE_TILE_STATE_MAPPED;
    tile->mapped_at = ++n->stamp;
}

void naive_become_wanted(struct naive_manager *n, struct naive_tile *tile, uint32_t need)
{
    tile->wanted = true;
    switch (tile->state) {
    case SLUICE_TILE_STATE_FREE: naive_request(n, tile, need); break;
    case SLUICE_TILE_STATE_STANDBY:
        naive_become_mapped(n, tile);
        tile->listed = false;
        n->totals.restoredTotal++;
        break;
    case SLUICE_TILE_STATE_CANCELED:
        if (!tile->cancel_handed_out)
            tile->state = SLUICE_TILE_STATE_ALLOCATED;
        break;
    case SLUICE_TILE_STATE_REQUESTED:
    case SLUICE_TILE_STATE_ALLOCATED:
    case SLUICE_TILE_STATE_MAPPED:
    case SLUICE_TILE_STATE_FAILED:
    case SLUICE_TILE_STATE_GIVEN_UP: abort(); /* already wanted */
    }
}

void naive_stand_by(struct naive_manager *n, struct naive_tile *tile)
{
    tile->state = SLUICE_TILE_STATE_STANDBY;
    tile->listed = false;
    tile->standby_at = ++n->stamp;
    naive_limit_standby(n);
}

void naive_evict(struct naive_manager *n, struct naive_tile *tile)
{
    tile->state = SLUICE_TILE_STATE_STANDBY;
    tile->listed = true;
    tile->listed_at = ++n->stamp;
    n->events[NAIVE_EVICTED]++;
}

void naive_become_unwanted(struct naive_manager *n, struct naive_tile *tile)
{
    tile->wanted = false;
    tile->failures = 0;
    switch (tile->state) {
    case SLUICE_TILE_STATE_REQUESTED:
    case SLUICE_TILE_STATE_FAILED:
    case SLUICE_TILE_STATE_GIVEN_UP: tile->state = SLUICE_TILE_STATE_FREE; break;
    case SLUICE_TILE_STATE_ALLOCATED:
        tile->state = SLUICE_TILE_STATE_CANCELED;
        tile->cancel_handed_out = false;
        tile->canceled_at = ++n->stamp;
        break;
    case SLUICE_TILE_STATE_MAPPED: naive_stand_by(n, tile); break;
    case SLUICE_TILE_STATE_CANCELED: break;
    case SLUICE_TILE_STATE_STANDBY: /* an evicted tile stays listed */
        n->events[NAIVE_EVICTED_UNWANTED]++;
        break;
    case SLUICE_TILE_STATE_FREE: abort(); /* not wanted */
    }
}

static void list_standby(struct naive_manager *n, bool outside, uint64_t keep)
{
    uint32_t count, unlisted = 0;
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_STANDBY, &count);
    for (uint32_t i = 0; i < count; i++)
        if (!refs[i].tile->listed && refs[i].tile->outside == outside) {
            refs[unlisted] = refs[i];
            refs[unlisted++].key[0] = refs[i].tile->standby_at;
        }
    naive_sort(refs, unlisted);
    for (uint64_t i = 0; i + keep < unlisted; i++) {
        refs[i].tile->listed = true;
        refs[i].tile->listed_at = ++n->stamp;
    }
    free(refs);
}

void naive_list_standby(struct naive_manager *n, uint64_t keep)
{
    list_standby(n, false, keep);
}

void naive_limit_standby(struct naive_manager *n)
{
    list_standby(n, false, n->config.numExtraStandbyTiles);
    list_standby(n, true, n->config.numExtraStandbyTiles);
}

/* Lists FAILED tiles in the order of their due times. */
static struct naive_ref *collect_failed(struct naive_manager *n, const struct naive_texture *only,
                                        uint32_t *count)
{
    struct naive_ref *refs = naive_collect(n, only, SLUICE_TILE_STATE_FAILED, count);
    for (uint32_t i = 0; i < *count; i++) {
        /* Shifted by half of the range relative to now, so that wrapping times sort correctly. */
        refs[i].key[0] = refs[i].tile->due - n->time + ((uint64_t)1 << 63);
        refs[i].key[1] = refs[i].tile->failed_at;
    }
    naive_sort(refs, *count);
    return refs;
}

void naive_retry_due(struct naive_manager *n, uint64_t now)
{
    uint32_t count;
    struct naive_ref *refs = collect_failed(n, NULL, &count);
    for (uint32_t i = 0; i < count; i++)
        if ((int64_t)(now - refs[i].tile->due) >= 0)
            naive_request(n, refs[i].tile, 0);
    free(refs);
    naive_probe_given_up(n);
}

SluiceResult naive_retry(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    const struct naive_texture *only = NULL;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    if (call->texture == SLUICE_NO_TEXTURE)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (call->texture != SLUICE_ALL_TEXTURES && !(only = naive_find(n, call->texture, &result)))
        return result;
    uint32_t count;
    struct naive_ref *refs = collect_failed(n, only, &count);
    for (uint32_t i = 0; i < count; i++)
        naive_request(n, refs[i].tile, 0);
    free(refs);
    refs = naive_collect(n, only, SLUICE_TILE_STATE_GIVEN_UP, &count);
    for (uint32_t i = 0; i < count; i++)
        refs[i].key[0] = refs[i].tile->given_up_at;
    naive_sort(refs, count);
    for (uint32_t i = 0; i < count; i++) {
        refs[i].tile->failures = 0;
        naive_request(n, refs[i].tile, 0);
    }
    free(refs);
    return SLUICE_SUCCESS;
}
