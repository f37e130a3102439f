#include "base/bytes.h"
#include "base/struct_size.h"
#include "core/clock.h"
#include "core/follower.h"
#include "core/history.h"
#include "core/lookup.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "core/wants.h"
#include "residency/nodes.h"

#include <inttypes.h>

static SluiceResult check_feedback(const slc_manager *m, SluiceTextureId id,
                                   const SluiceFeedbackDesc *f, uint64_t time,
                                   struct slc_managed_texture **t)
{
    if (!f || !f->pMinMip)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_find_texture(m, id, t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (f->width != (*t)->shape->feedback_width || f->height != (*t)->shape->feedback_height)
        return SLUICE_ERROR_SIZE_MISMATCH;
    return slc_time_is_backwards(m, time) ? SLUICE_ERROR_TIME_BACKWARDS : SLUICE_SUCCESS;
}

/** Most tiles of textures that share a history: the log of moves for followers has one per tile. */
enum { MAX_SHARED_TILES = 65536 };

static size_t log_size(const struct slc_managed_texture *t)
{
    if (t->first_follower == SLC_NONE || t->shape->regular_tile_count > MAX_SHARED_TILES)
        return 0;
    return slc_padded(t->shape->regular_tile_count * sizeof(struct slc_move));
}

/** Reserves scratch for the log, and for the maps of a texture and of its followers behind it. */
static SluiceResult reserve_scratch(slc_manager *m, const struct slc_managed_texture *t)
{
    size_t work = t->shape->work_size;
    uint64_t bytes = slc_padded(t->shape->region_count) + log_size(t);
    for (uint32_t i = t->first_follower; i != SLC_NONE;) {
        const struct slc_managed_texture *f = slc_texture_at(m, i);
        bytes += slc_follower_scratch(t, f);
        work = f->shape->work_size > work ? f->shape->work_size : work;
        i = f->next_follower;
    }
    return slc_wants_reserve_scratch(m, bytes, work);
}

/** Counts the textures that share the texture's history and will get its map: itself and followers.
 */
static uint32_t users_of_history(const slc_manager *m, const struct slc_managed_texture *t)
{
    const struct slc_history *h = t->history;
    /* a bias is dithered differently in each texture */
    if (!h || h->users == 1 || m->bias.value || h->bias)
        return 1;
    uint32_t users = 1;
    for (uint32_t f = t->first_follower; f != SLC_NONE; f = slc_texture_at(m, f)->next_follower)
        users += slc_texture_at(m, f)->history == h;
    return users;
}

/**
 * Whether a follower without a history can share the new history of its primary. An empty map makes
 * no history for a follower without a state, though the primary may have one.
 */
static bool may_share(const slc_manager *m, const struct slc_managed_texture *t,
                      const struct slc_managed_texture *follower)
{
    return t->history && (t->history->next || follower->nodes) && !follower->history &&
           !follower->uv && m->bias.value == 0 && t->hits == follower->hits &&
           t->returns == follower->returns && t->shape->regular_tile_count <= MAX_SHARED_TILES &&
           slc_have_same_shape(t, follower);
}

static SluiceResult prepare_followers(slc_manager *m, struct slc_managed_texture *t, bool is_new,
                                      struct slc_wants_need *need)
{
    const struct slc_history *h = t->history;
    const uint8_t *asked = !h ? NULL : h->next ? h->next : h->asked;
    uint64_t nodes = need->nodes;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = t->first_follower; i != SLC_NONE && result == SLUICE_SUCCESS;) {
        struct slc_managed_texture *f = slc_texture_at(m, i);
        if (is_new && may_share(m, t, f)) {
            result = slc_state_make(m, f);
            if (result == SLUICE_SUCCESS)
                slc_history_share(f, t->history);
        }
        if (h && f->history == h)
            need->nodes += nodes;
        else if (result == SLUICE_SUCCESS)
            result = slc_wants_prepare_follower(m, t, asked, f, need);
        i = f->next_follower;
    }
    return result;
}

static SluiceResult prepare(slc_manager *m, struct slc_managed_texture *t,
                            const SluiceFeedbackDesc *feedback)
{
    struct slc_wants_need need = {.scratch = log_size(t)};
    bool is_new = !t->history;
    SluiceResult result = reserve_scratch(m, t);
    if (result == SLUICE_SUCCESS)
        result = slc_wants_prepare(m, t, feedback, users_of_history(m, t), &need);
    if (result == SLUICE_SUCCESS)
        result = prepare_followers(m, t, is_new, &need);
    if (result == SLUICE_SUCCESS)
        result = slc_reserve_nodes(&m->residency, need.nodes) ? SLUICE_SUCCESS
                                                              : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        return result;
    slc_wants_abandon(m, t);
    for (uint32_t f = t->first_follower; f != SLC_NONE; f = slc_texture_at(m, f)->next_follower)
        slc_wants_abandon(m, slc_texture_at(m, f));
    return result;
}

static void commit(slc_manager *m, struct slc_managed_texture *t, uint64_t time, uint64_t timeout)
{
    const struct slc_history *h = t->history; /* followers keep it if the texture ends its own */
    struct slc_move_log log = {(struct slc_move *)(void *)m->scratch, 0};
    bool shared = h && h->users > 1;
    slc_wants_commit(m, t, time, timeout, shared ? &log : NULL);
    for (uint32_t i = t->first_follower; i != SLC_NONE;) {
        struct slc_managed_texture *f = slc_texture_at(m, i);
        if (shared && f->history == h)
            slc_wants_repeat(m, t, f, time, timeout, &log);
        else
            slc_wants_commit(m, f, time, timeout, NULL);
        i = f->next_follower;
    }
}

/** True if neither earlier maps nor this one request anything. */
static bool changes_nothing(const slc_manager *m, const struct slc_managed_texture *t,
                            const SluiceFeedbackDesc *feedback)
{
    if (t->nodes || !slc_bytes_are(feedback->pMinMip, slc_region_count(t), SLUICE_MIP_UNTOUCHED))
        return false;
    for (uint32_t i = t->first_follower; i != SLC_NONE; i = slc_texture_at(m, i)->next_follower)
        if (slc_texture_at(m, i)->nodes)
            return false;
    return true;
}

static SluiceResult update(slc_manager *m, SluiceTextureId id, const SluiceFeedbackDesc *feedback,
                           uint64_t time, uint64_t timeout)
{
    struct slc_managed_texture *t;
    SluiceResult result = check_feedback(m, id, feedback, time, &t);
    if (result == SLUICE_SUCCESS && !changes_nothing(m, t, feedback))
        result = prepare(m, t, feedback);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_advance_time(m, time);
    commit(m, t, time, timeout);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceUpdateWithSamplerFeedback(SluiceStreamedTextureManager *manager,
                                             SluiceTextureId textureId,
                                             const SluiceFeedbackDesc *pFeedback,
                                             uint64_t timeStamp, uint64_t timeout)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    const SluiceFeedbackDesc *feedback = pFeedback;
    SluiceFeedbackDesc given;
    /* No copy if the size is right. The caller has just written the fields one by one, so a copy
     * with wide loads would wait for all these stores: longer than the work on an unchanged map. */
    if (feedback && feedback->structSize != sizeof given) {
        SluiceResult result =
            slc_struct_read(SLC_STRUCT(SluiceFeedbackDesc), &given, feedback, &manager->info.log);
        if (result != SLUICE_SUCCESS)
            return result; /* a recording has no form for it */
        feedback = &given;
    }
    struct slc_call call = {.kind = SLC_CALL_UPDATE_FEEDBACK,
                            .texture_id = textureId,
                            .feedback = feedback,
                            .time_stamp = timeStamp,
                            .timeout = timeout,
                            .result = update(manager, textureId, feedback, timeStamp, timeout)};
    slc_notify(manager, &call);
    return call.result;
}

static SluiceResult match(slc_manager *m, SluiceTextureId primary_id, SluiceTextureId follower_id,
                          uint64_t time, uint64_t timeout)
{
    struct slc_managed_texture *p, *t;
    SluiceResult result = slc_find_texture(m, primary_id, &p);
    if (result == SLUICE_SUCCESS)
        result = slc_find_texture(m, follower_id, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (p == t)
        return slc_refuse(m, "sluiceMatchPrimaryTexture",
                          "primaryId and followerId are both %#" PRIx64, primary_id);
    if (slc_time_is_backwards(m, time))
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (p->has_map && (p->nodes || t->nodes)) {
        struct slc_wants_need need = {0};
        result = slc_wants_reserve_scratch(m, slc_follower_scratch(p, t), t->shape->work_size);
        const struct slc_history *h = p->history;
        if (result == SLUICE_SUCCESS)
            result = slc_wants_prepare_follower(m, p, h ? h->asked : NULL, t, &need);
        if (result == SLUICE_SUCCESS)
            result = slc_reserve_nodes(&m->residency, need.nodes) ? SLUICE_SUCCESS
                                                                  : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        if (result != SLUICE_SUCCESS) {
            slc_wants_abandon(m, t);
            return result;
        }
    }
    slc_advance_time(m, time);
    if (p->has_map)
        slc_wants_commit(m, t, time, timeout, NULL);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceMatchPrimaryTexture(SluiceStreamedTextureManager *manager,
                                       SluiceTextureId primaryId, SluiceTextureId followerId,
                                       uint64_t timeStamp, uint64_t timeout)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_MATCH_PRIMARY,
                            .texture_id = followerId,
                            .primary_id = primaryId,
                            .time_stamp = timeStamp,
                            .timeout = timeout,
                            .result = match(manager, primaryId, followerId, timeStamp, timeout)};
    slc_notify(manager, &call);
    return call.result;
}
