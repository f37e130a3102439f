/* Eviction of a texture that the caller knows to be out of sight. */
#include "core/history.h"
#include "core/lookup.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "core/wants.h"
#include "residency/standby.h"

/* Textures without a state have no nodes of regular tiles. */
static uint32_t first_tile(const struct slc_managed_texture *t)
{
    return t->nodes ? 0 : t->shape->regular_tile_count;
}

/* Returns the node of a STANDBY tile that is not listed for unmapping yet. 0: any other tile. */
static uint32_t idle_node(const slc_manager *m, const struct slc_managed_texture *t, uint32_t tile)
{
    uint32_t node = slc_find_node(t, tile);
    if (!node)
        return 0;
    const struct slc_node *n = slc_node_at(&m->residency, node);
    return n->state == SLUICE_TILE_STATE_STANDBY && !(n->flags & SLC_NODE_LISTED) ? node : 0;
}

/* Lists STANDBY tiles for unmapping until `keep` are left, finer levels first. */
static void list_tiles(slc_manager *m, const struct slc_managed_texture *t, uint32_t keep)
{
    uint32_t count = 0, end = t->shape->tile_count;
    for (uint32_t tile = first_tile(t); tile < end; tile++)
        count += idle_node(m, t, tile) != 0;
    for (uint32_t tile = first_tile(t); tile < end && count > keep; tile++) {
        uint32_t node = idle_node(m, t, tile);
        if (!node)
            continue;
        slc_list_for_unmapping(&m->residency, node);
        count--;
    }
}

static void evict(slc_manager *m, struct slc_managed_texture *t, uint32_t keep)
{
    if (t->held_regions > 0)
        slc_wants_drop(m, t);
    list_tiles(m, t, keep);
}

static SluiceResult evict_texture(slc_manager *m, SluiceTextureId id, uint32_t keep)
{
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(m, id, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    m->events.reason = SLUICE_TILE_EVENT_CALLED;
    evict(m, t, keep);
    for (uint32_t i = t->first_follower; i != SLC_NONE; i = slc_texture_at(m, i)->next_follower)
        evict(m, slc_texture_at(m, i), keep);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceEvictStreamedTexture(SluiceStreamedTextureManager *manager,
                                        SluiceTextureId textureId, uint32_t keepTileCount)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_EVICT_TEXTURE,
                            .texture_id = textureId,
                            .keep_count = keepTileCount,
                            .result = evict_texture(manager, textureId, keepTileCount)};
    slc_notify(manager, &call);
    return call.result;
}
