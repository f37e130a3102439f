#include "core/priority.h"

#include "core/lookup.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "residency/request_queues.h"

static int32_t weight(void *user, uint32_t owner)
{
    return slc_priority_of(user, slc_texture_at(user, owner));
}

void slc_use_priorities(slc_manager *m)
{
    m->residency.user.weight = weight;
}

void slc_priority_changed(slc_manager *m, const struct slc_managed_texture *t, int32_t before)
{
    if (slc_priority_of(m, t) == before)
        return;
    uint32_t count = t->shape->tile_count, left = t->requested_count;
    for (uint32_t tile = 0; tile < count && left > 0; tile++) {
        uint32_t node = slc_find_node(t, tile);
        if (!node || slc_node_at(&m->residency, node)->state != SLUICE_TILE_STATE_REQUESTED)
            continue;
        struct slc_node *n = slc_node_at(&m->residency, node);
        slc_request_remove(&m->residency, node);
        n->need = (uint8_t)(n->need > before ? n->need - before : 0); /* append adds the new one */
        n->need = n->need < SLC_REQUEST_NEEDS ? n->need : SLC_REQUEST_NEEDS - 1;
        slc_request_append(&m->residency, node);
        left--;
    }
}

static SluiceResult set_priority(slc_manager *m, SluiceTextureId id, int32_t priority)
{
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(m, id, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (priority < -SLUICE_MAX_PRIORITY || priority > SLUICE_MAX_PRIORITY)
        return slc_refuse(m, "sluiceSetTexturePriority", "priority is %d; it must be %d to %d",
                          (int)priority, -SLUICE_MAX_PRIORITY, SLUICE_MAX_PRIORITY);
    int32_t before = t->priority;
    if (priority == before)
        return SLUICE_SUCCESS;
    slc_use_priorities(m);
    t->priority = (int8_t)priority;
    if (t->primary == SLC_NONE)
        slc_priority_changed(m, t, before);
    for (uint32_t i = t->first_follower; i != SLC_NONE; i = slc_texture_at(m, i)->next_follower)
        slc_priority_changed(m, slc_texture_at(m, i), before);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceSetTexturePriority(SluiceStreamedTextureManager *manager,
                                      SluiceTextureId textureId, int32_t priority)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_SET_PRIORITY,
                            .texture_id = textureId,
                            .priority = priority,
                            .result = set_priority(manager, textureId, priority)};
    slc_notify(manager, &call);
    return call.result;
}
