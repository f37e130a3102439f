/* Lists that the manager returns, except that of tiles to map. */
#include "core/naive_manager.h"

#include <stdlib.h>

static uint32_t min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

SluiceResult naive_check_list(struct naive_manager *n, const struct call *call,
                              struct naive_texture **only)
{
    SluiceResult result;
    *only = NULL;
    if (call->null == NULL_MANAGER || call->null == NULL_FIRST)
        return SLUICE_ERROR_NULL_POINTER;
    if (call->texture == SLUICE_NO_TEXTURE)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (call->texture != SLUICE_ALL_TEXTURES && !(*only = naive_find(n, call->texture, &result)))
        return result;
    return SLUICE_SUCCESS;
}

SluiceResult naive_given_up_tiles(struct naive_manager *n, const struct call *call,
                                  struct outcome *out)
{
    if (call->null == NULL_MANAGER || call->null == NULL_FIRST)
        return SLUICE_ERROR_NULL_POINTER;
    out->count = n->given_up_count;
    if (call->null == NULL_SECOND)
        return SLUICE_SUCCESS;
    out->count = min_u32(call->room, n->given_up_count);
    for (uint32_t i = 0; i < out->count; i++) {
        SluiceResult result;
        out->tiles[i] =
            naive_tile_info(naive_find(n, n->given_up[i].texture, &result), n->given_up[i].tile);
    }
    n->given_up_count -= out->count;
    for (uint32_t i = 0; i < n->given_up_count; i++)
        n->given_up[i] = n->given_up[i + out->count];
    return n->given_up_count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

SluiceResult naive_tiles_to_cancel(struct naive_manager *n, const struct call *call,
                                   struct outcome *out)
{
    struct naive_texture *only;
    SluiceResult result = naive_check_list(n, call, &only);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t canceled, count = 0;
    struct naive_ref *refs = naive_collect(n, only, SLUICE_TILE_STATE_CANCELED, &canceled);
    for (uint32_t i = 0; i < canceled; i++)
        if (!refs[i].tile->cancel_handed_out) {
            refs[count] = refs[i];
            refs[count++].key[0] = refs[i].tile->canceled_at;
        }
    naive_sort(refs, count);
    out->count = call->null == NULL_SECOND ? count : min_u32(call->room, count);
    for (uint32_t i = 0; i < out->count && call->null != NULL_SECOND; i++) {
        struct naive_texture *t = refs[i].texture;
        refs[i].tile->cancel_handed_out = true;
        out->tiles[i] = naive_tile_info(t, (uint32_t)(refs[i].tile - t->tiles));
    }
    free(refs);
    return out->count < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

static void unmap_tile(struct naive_manager *n, struct naive_texture *t, struct naive_tile *tile,
                       uint64_t retire)
{
    naive_retire_slot(n, tile, retire);
    tile->state = SLUICE_TILE_STATE_FREE;
    tile->listed = false;
    if (tile->wanted) { /* it was evicted */
        naive_request(n, tile, 0);
        n->events[NAIVE_EVICTED_UNMAPPED]++;
    }
    n->totals.unmappedTotal++;
    t->minmip_stale = true;
    naive_update_minmip(n, t);
}

SluiceResult naive_tiles_to_unmap(struct naive_manager *n, const struct call *call,
                                  struct outcome *out)
{
    struct naive_texture *only;
    SluiceResult result = naive_check_list(n, call, &only);
    if (result != SLUICE_SUCCESS)
        return result;
    if (call->retire != 0 && call->retire < n->last_retire)
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (call->retire != 0 && call->null != NULL_SECOND)
        n->last_retire = call->retire;
    uint32_t standby, count = 0;
    struct naive_ref *refs = naive_collect(n, only, SLUICE_TILE_STATE_STANDBY, &standby);
    for (uint32_t i = 0; i < standby; i++)
        if (refs[i].tile->listed) {
            refs[count] = refs[i];
            refs[count++].key[0] = refs[i].tile->listed_at;
        }
    naive_sort(refs, count);
    out->count = call->null == NULL_SECOND ? count : min_u32(call->room, count);
    for (uint32_t i = 0; i < out->count && call->null != NULL_SECOND; i++) {
        struct naive_texture *t = refs[i].texture;
        out->tiles[i] = naive_tile_info(t, (uint32_t)(refs[i].tile - t->tiles));
        unmap_tile(n, t, refs[i].tile, call->retire);
    }
    free(refs);
    return out->count < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}
