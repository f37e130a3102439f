#include "core/forget_texture.h"

#include "core/clock.h"
#include "core/history.h"
#include "core/lookup.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "residency/node.h"
#include "residency/nodes.h"

/* Textures without a state have no nodes of regular tiles. */
static uint32_t first_tile(const struct slc_managed_texture *t)
{
    return t->nodes ? 0 : t->shape->regular_tile_count;
}

/* True if all tiles are FREE or STANDBY: none is wanted, loading, or waiting for a retry. */
static bool is_idle(const slc_manager *m, const struct slc_managed_texture *t)
{
    if (t->held_regions > 0)
        return false;
    for (uint32_t tile = first_tile(t); tile < t->shape->tile_count; tile++) {
        uint32_t node = slc_find_node(t, tile);
        if (node && slc_node_at(&m->residency, node)->state != SLUICE_TILE_STATE_STANDBY)
            return false;
    }
    return true;
}

static SluiceResult forget_texture(slc_manager *m, SluiceTextureId id, uint64_t retire_value)
{
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(m, id, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_retire_is_backwards(m, retire_value))
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (!is_idle(m, t))
        return SLUICE_NOT_READY;
    if (retire_value)
        m->last_retire = retire_value;
    m->events.reason = SLUICE_TILE_EVENT_REMOVED;
    for (uint32_t tile = first_tile(t); tile < t->shape->tile_count; tile++)
        if (slc_find_node(t, tile))
            slc_node_retire(&m->residency, slc_find_node(t, tile), retire_value);
    slc_state_release(m, t);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceForgetStreamedTexture(SluiceStreamedTextureManager *manager,
                                         SluiceTextureId textureId, uint64_t retireValue)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_FORGET_TEXTURE,
                            .texture_id = textureId,
                            .retire_value = retireValue,
                            .result = forget_texture(manager, textureId, retireValue)};
    slc_notify(manager, &call);
    return call.result;
}

bool slc_manager_wants_texture(const SluiceStreamedTextureManager *manager, SluiceTextureId id)
{
    struct slc_managed_texture *t;
    return slc_find_texture(manager, id, &t) == SLUICE_SUCCESS && t->held_regions > 0;
}
