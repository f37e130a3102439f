#include "core/sets.h"

#include "base/alloc.h"
#include "core/history.h"
#include "core/lookup.h"
#include "core/observer.h"
#include "core/priority.h"
#include "core/refusal.h"
#include "core/uv_transform.h"

void slc_unfollow(slc_manager *m, struct slc_managed_texture *t)
{
    if (t->primary == SLC_NONE)
        return;
    struct slc_managed_texture *p = slc_texture_at(m, t->primary);
    if (t->prev_follower == SLC_NONE)
        p->first_follower = t->next_follower;
    else
        slc_texture_at(m, t->prev_follower)->next_follower = t->next_follower;
    if (t->next_follower == SLC_NONE)
        p->last_follower = t->prev_follower;
    else
        slc_texture_at(m, t->next_follower)->prev_follower = t->prev_follower;
    t->primary = t->prev_follower = t->next_follower = SLC_NONE;
}

void slc_follow(slc_manager *m, struct slc_managed_texture *t, struct slc_managed_texture *primary)
{
    t->primary = primary->index;
    t->prev_follower = primary->last_follower;
    if (primary->last_follower == SLC_NONE)
        primary->first_follower = t->index;
    else
        slc_texture_at(m, primary->last_follower)->next_follower = t->index;
    primary->last_follower = t->index;
}

static SluiceResult set_primary(slc_manager *m, SluiceTextureId follower_id,
                                SluiceTextureId primary_id)
{
    struct slc_managed_texture *t, *p = NULL;
    SluiceResult result = slc_find_texture(m, follower_id, &t);
    if (result == SLUICE_SUCCESS && primary_id != SLUICE_NO_TEXTURE)
        result = slc_find_texture(m, primary_id, &p);
    if (result != SLUICE_SUCCESS)
        return result;
    if (p && (p == t || p->primary != SLC_NONE || t->first_follower != SLC_NONE))
        return slc_refuse(m, "sluiceSetPrimaryTexture", "%s",
                          p == t                   ? "a texture cannot follow itself"
                          : p->primary != SLC_NONE ? "primaryId follows another texture"
                                                   : "followerId has followers of its own");
    if (p && t->primary == p->index)
        return SLUICE_SUCCESS;
    int32_t before = slc_priority_of(m, t);
    slc_unfollow(m, t);
    if (p)
        slc_follow(m, t, p);
    slc_priority_changed(m, t, before);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceSetPrimaryTexture(SluiceStreamedTextureManager *manager,
                                     SluiceTextureId followerId, SluiceTextureId primaryId)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_SET_PRIMARY,
                            .texture_id = followerId,
                            .primary_id = primaryId,
                            .result = set_primary(manager, followerId, primaryId)};
    slc_notify(manager, &call);
    return call.result;
}

/* Gives a follower a history of its own, because it gets other maps than its primary from now on.
 */
static SluiceResult leave_shared_history(slc_manager *m, struct slc_managed_texture *t)
{
    if (!t->history || t->history->users == 1)
        return SLUICE_SUCCESS;
    return slc_history_make(m, t, 1);
}

static SluiceResult set_uv(slc_manager *m, SluiceTextureId id, const SluiceUvTransform *transform)
{
    struct slc_managed_texture *t;
    struct slc_uv_transform uv, *own = NULL;
    SluiceResult result = slc_find_texture(m, id, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    const char *wrong = transform ? slc_uv_transform_read(&uv, transform) : NULL;
    if (wrong)
        return slc_refuse(m, "sluiceSetUvTransform", "scale %g, %g, offset %g, %g, wrap %d, %d: %s",
                          (double)transform->scaleU, (double)transform->scaleV,
                          (double)transform->offsetU, (double)transform->offsetV,
                          (int)transform->wrapU, (int)transform->wrapV, wrong);
    if (transform && !slc_uv_transform_is_none(&uv)) {
        own = t->uv ? t->uv : slc_alloc(&m->cb, 1, sizeof *own);
        if (!own)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        result = leave_shared_history(m, t);
    }
    if (result != SLUICE_SUCCESS) {
        slc_free(&m->cb, t->uv ? NULL : own, 1, sizeof *own);
        return result;
    }
    if (own)
        *own = uv;
    else
        slc_free(&m->cb, t->uv, 1, sizeof *t->uv);
    t->uv = own;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceSetUvTransform(SluiceStreamedTextureManager *manager, SluiceTextureId textureId,
                                  const SluiceUvTransform *pTransform)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_SET_UV,
                            .texture_id = textureId,
                            .uv = pTransform,
                            .result = set_uv(manager, textureId, pTransform)};
    slc_notify(manager, &call);
    return call.result;
}
