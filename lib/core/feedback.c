#include "core/history.h"
#include "core/wants.h"

#include "base/bytes.h"

static SluiceResult check_feedback(const slc_manager *m, SluiceTextureId id,
                                   const SluiceFeedbackDesc *f, uint64_t time,
                                   struct slc_texture **t)
{
    if (!f || !f->pMinMip)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_find_texture(m, id, t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (f->width != (*t)->feedback_width || f->height != (*t)->feedback_height)
        return SLUICE_ERROR_SIZE_MISMATCH;
    return slc_time_is_backwards(m, time) ? SLUICE_ERROR_TIME_BACKWARDS : SLUICE_SUCCESS;
}

/** Scratch for the maps of a texture and of those that follow it. */
static SluiceResult reserve_scratch(slc_manager *m, const struct slc_texture *t, bool followers)
{
    size_t work = slc_wants_work_size(t);
    uint64_t bytes = slc_padded(slc_region_count(t));
    for (uint32_t f = followers ? t->first_follower : SLC_NONE; f != SLC_NONE;
         f = slc_texture_at(m, f)->next_follower) {
        size_t own = slc_wants_work_size(slc_texture_at(m, f));
        bytes += slc_padded(slc_region_count(slc_texture_at(m, f)));
        work = own > work ? own : work;
    }
    return slc_wants_reserve_scratch(m, bytes, work);
}

static SluiceResult prepare(slc_manager *m, struct slc_texture *t,
                            const SluiceFeedbackDesc *feedback)
{
    struct slc_wants_need need = {0};
    SluiceResult result = reserve_scratch(m, t, true);
    if (result == SLUICE_SUCCESS)
        result = slc_wants_prepare(m, t, feedback, &need);
    for (uint32_t f = t->first_follower; f != SLC_NONE && result == SLUICE_SUCCESS;
         f = slc_texture_at(m, f)->next_follower) {
        const struct slc_texture_state *s = t->state;
        const uint8_t *asked = !s ? NULL : s->next ? s->next : s->asked;
        result = slc_wants_prepare_follower(m, t, asked, slc_texture_at(m, f), &need);
    }
    if (result == SLUICE_SUCCESS)
        result =
            slc_reserve_nodes(m, need.nodes) ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        return result;
    slc_wants_abandon(m, t);
    for (uint32_t f = t->first_follower; f != SLC_NONE; f = slc_texture_at(m, f)->next_follower)
        slc_wants_abandon(m, slc_texture_at(m, f));
    return result;
}

static SluiceResult update(slc_manager *m, SluiceTextureId id, const SluiceFeedbackDesc *feedback,
                           uint64_t time, uint64_t timeout)
{
    struct slc_texture *t;
    SluiceResult result = check_feedback(m, id, feedback, time, &t);
    if (result == SLUICE_SUCCESS)
        result = prepare(m, t, feedback);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_advance_time(m, time);
    slc_wants_commit(m, t, time, timeout);
    for (uint32_t f = t->first_follower; f != SLC_NONE; f = slc_texture_at(m, f)->next_follower)
        slc_wants_commit(m, slc_texture_at(m, f), time, timeout);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceUpdateWithSamplerFeedback(SluiceStreamedTextureManager *manager,
                                             SluiceTextureId textureId,
                                             const SluiceFeedbackDesc *pFeedback,
                                             uint64_t timeStamp, uint64_t timeout)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_UPDATE_FEEDBACK,
                            .texture_id = textureId,
                            .feedback = pFeedback,
                            .time_stamp = timeStamp,
                            .timeout = timeout,
                            .result = update(manager, textureId, pFeedback, timeStamp, timeout)};
    slc_notify(manager, &call);
    return call.result;
}

static SluiceResult match(slc_manager *m, SluiceTextureId primary_id, SluiceTextureId follower_id,
                          uint64_t time, uint64_t timeout)
{
    struct slc_texture *p, *t;
    SluiceResult result = slc_find_texture(m, primary_id, &p);
    if (result == SLUICE_SUCCESS)
        result = slc_find_texture(m, follower_id, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (p == t)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (slc_time_is_backwards(m, time))
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (p->has_map && (p->state || t->state)) {
        struct slc_wants_need need = {0};
        result = reserve_scratch(m, t, false);
        if (result == SLUICE_SUCCESS)
            result = slc_wants_prepare_follower(m, p, p->state ? p->state->asked : NULL, t, &need);
        if (result == SLUICE_SUCCESS)
            result =
                slc_reserve_nodes(m, need.nodes) ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        if (result != SLUICE_SUCCESS) {
            slc_wants_abandon(m, t);
            return result;
        }
    }
    slc_advance_time(m, time);
    if (p->has_map)
        slc_wants_commit(m, t, time, timeout);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceMatchPrimaryTexture(SluiceStreamedTextureManager *manager,
                                       SluiceTextureId primaryId, SluiceTextureId followerId,
                                       uint64_t timeStamp, uint64_t timeout)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_MATCH_PRIMARY,
                            .texture_id = followerId,
                            .primary_id = primaryId,
                            .time_stamp = timeStamp,
                            .timeout = timeout,
                            .result = match(manager, primaryId, followerId, timeStamp, timeout)};
    slc_notify(manager, &call);
    return call.result;
}
