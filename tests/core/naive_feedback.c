/* Requests of feedback maps, for textures and their followers. */
#include "core/naive_manager.h"

#include <stdlib.h>
#include <string.h>

#define NOTHING SLUICE_MIP_UNTOUCHED

static uint32_t min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint64_t region_end(uint32_t r, uint32_t region_size, uint32_t size)
{
    uint64_t end = ((uint64_t)r + 1) * region_size;
    return end < size ? end : size;
}

/* Notes the map's time, even if nothing else is noted. */
static void note_time(struct naive_manager *n, struct naive_texture *t, uint64_t time,
                      uint64_t timeout)
{
    if (t->map_stamp && t->map_time != time) {
        t->interval = time - t->map_time;
        n->usual = t->interval;
    }
    t->map_stamp = ++n->stamp;
    t->map_time = time;
    t->map_timeout = timeout;
}

static bool asks_for_anything(const struct naive_texture *t, const uint8_t *asked)
{
    for (uint32_t r = 0; r < t->layout.feedbackWidth * t->layout.feedbackHeight; r++)
        if (asked[r] != NOTHING)
            return true;
    return false;
}

/* Merges a map. `asked`: `a` by region, 255: nothing. The texture takes ownership. */
static void merge_map(struct naive_manager *n, struct naive_texture *t, uint8_t *asked,
                      uint64_t time, uint64_t timeout)
{
    note_time(n, t, time, timeout);
    if (naive_has_state(t) || asks_for_anything(t, asked)) {
        n->bias.maps++;
        n->round.maps++;
        const bool held = naive_holds_anything(t);
        uint8_t *wishes = naive_alloc(t->layout.regularTileCount, 1);
        naive_wishes(t, t->held, wishes);
        naive_remember(n, t, asked, time, timeout);
        naive_apply_held(n, t);
        naive_note_change(n, t, wishes, held);
        free(wishes);
    }
    free(t->last_asked);
    t->last_asked = asked;
    naive_wishes(t, asked, t->last_wishes);
}

static int64_t clamp_i64(int64_t value, int64_t low, int64_t high)
{
    return value < low ? low : value > high ? high : value;
}

/* Returns whether region r of one texture and region q of the other overlap by more than a
 * border. */
static bool overlap(uint32_t r, uint32_t r_size, uint32_t w, uint32_t q, uint32_t q_size,
                    uint32_t other_w)
{
    uint64_t x0 = (uint64_t)r * r_size, x1 = region_end(r, r_size, w);
    uint64_t q0 = (uint64_t)q * q_size, q1 = region_end(q, q_size, other_w);
    return x0 * other_w < q1 * w && q0 * w < x1 * other_w;
}

/* Returns whether size >= other * 2^d. */
static bool at_least(uint64_t size, uint64_t other, int d)
{
    return d >= 0 ? size >= other << d : size << -d >= other;
}

static int level_offset(const SluiceStreamedTextureDesc *follower,
                        const SluiceStreamedTextureDesc *primary)
{
    int d = 20;
    while (!at_least(follower->width, primary->width, d) ||
           !at_least(follower->height, primary->height, d))
        d--;
    return d;
}

static void follow(struct naive_manager *n, const struct naive_texture *primary,
                   struct naive_texture *t, uint64_t time, uint64_t timeout)
{
    const SluiceStreamedTextureLayout *l = &t->layout, *p = &primary->layout;
    const int offset = level_offset(&l->desc, &p->desc);
    uint8_t *asked = naive_alloc((size_t)l->feedbackWidth * l->feedbackHeight, 1);
    for (uint32_t ry = 0; ry < l->feedbackHeight; ry++)
        for (uint32_t rx = 0; rx < l->feedbackWidth; rx++) {
            uint32_t least = NOTHING;
            for (uint32_t q = 0; q < p->feedbackWidth * p->feedbackHeight; q++)
                if (overlap(rx, l->desc.feedbackRegionWidth, l->desc.width, q % p->feedbackWidth,
                            p->desc.feedbackRegionWidth, p->desc.width) &&
                    overlap(ry, l->desc.feedbackRegionHeight, l->desc.height, q / p->feedbackWidth,
                            p->desc.feedbackRegionHeight, p->desc.height))
                    least = min_u32(least, primary->last_asked[q]);
            asked[ry * l->feedbackWidth + rx] =
                least == NOTHING ? NOTHING
                                 : (uint8_t)clamp_i64((int64_t)least + offset, 0,
                                                      (int64_t)l->desc.mipLevelCount - 1);
        }
    merge_map(n, t, asked, time, timeout);
}

static bool time_is_backwards(const struct naive_manager *n, uint64_t time)
{
    return n->has_time && (int64_t)(time - n->time) < 0;
}

static void feed_followers(struct naive_manager *n, const struct naive_texture *primary,
                           uint64_t time, uint64_t timeout)
{
    struct naive_ref *refs = naive_alloc(n->texture_room, sizeof *refs);
    uint32_t count = 0;
    for (uint32_t i = 0; i < n->texture_room; i++) {
        struct naive_texture *t = n->textures[i];
        if (t && t->primary == primary->id)
            refs[count++] = (struct naive_ref){t, NULL, {t->follower_since, 0, 0, 0}};
    }
    naive_sort(refs, count);
    for (uint32_t i = 0; i < count; i++)
        follow(n, primary, refs[i].texture, time, timeout);
    free(refs);
}

SluiceResult naive_feedback(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    if (call->null != NULL_NONE || call->null_map)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    const SluiceStreamedTextureLayout *l = &t->layout;
    if (call->map_width != l->feedbackWidth || call->map_height != l->feedbackHeight)
        return SLUICE_ERROR_SIZE_MISMATCH;
    if (time_is_backwards(n, call->time))
        return SLUICE_ERROR_TIME_BACKWARDS;
    n->has_time = true;
    n->time = call->time;
    naive_retry_due(n, call->time);

    const int64_t last = (int64_t)l->desc.mipLevelCount - 1;
    const int64_t regular = l->desc.regularMipCount;
    int64_t low = call->streamed_levels ? regular - (int64_t)call->streamed_levels : 0;
    low = low < 0 ? 0 : low;
    uint8_t *asked = naive_alloc((size_t)l->feedbackWidth * l->feedbackHeight, 1);
    for (uint32_t r = 0; r < l->feedbackWidth * l->feedbackHeight; r++) {
        int64_t v = call->map[r];
        asked[r] = v == NOTHING ? NOTHING
                                : (uint8_t)clamp_i64((v < last ? v : last) + call->bias, low, last);
    }
    merge_map(n, t, asked, call->time, call->timeout);
    feed_followers(n, t, call->time, call->timeout);
    return SLUICE_SUCCESS;
}

SluiceResult naive_match(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *primary = naive_find(n, call->primary, &result);
    if (!primary)
        return result;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    if (t == primary)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (time_is_backwards(n, call->time))
        return SLUICE_ERROR_TIME_BACKWARDS;
    n->has_time = true;
    n->time = call->time;
    naive_retry_due(n, call->time);
    if (primary->last_asked)
        follow(n, primary, t, call->time, call->timeout);
    return SLUICE_SUCCESS;
}
