/* Levels that the regions of a texture hold: the section "What a region holds". */
#include "core/naive_manager.h"

#include <stdlib.h>
#include <string.h>

#define NOTHING SLUICE_MIP_UNTOUCHED
#define MAX_WEIGHT UINT32_MAX

static uint64_t max_u64(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static uint32_t count_regions(const struct naive_texture *t)
{
    return t->layout.feedbackWidth * t->layout.feedbackHeight;
}

bool naive_holds_anything(const struct naive_texture *t)
{
    for (uint32_t r = 0; r < count_regions(t); r++)
        if (t->held[r] != NOTHING)
            return true;
    return false;
}

bool naive_has_state(const struct naive_texture *t)
{
    for (uint32_t i = 0; i < t->layout.regularTileCount; i++)
        if (t->tiles[i].state != SLUICE_TILE_STATE_FREE)
            return true;
    return naive_holds_anything(t);
}

static void delete_span(struct naive_texture *t, uint32_t at)
{
    free(t->spans[at].asked);
    t->span_count--;
    for (uint32_t i = at; i < t->span_count; i++)
        t->spans[i] = t->spans[i + 1];
}

void naive_forget_history(struct naive_texture *t)
{
    while (t->span_count)
        delete_span(t, t->span_count - 1);
    free(t->known);
    t->known = NULL;
    t->absence = 0;
}

static uint8_t least_of(const struct naive_texture *t, uint32_t r)
{
    uint8_t least = NOTHING;
    for (uint32_t i = 0; i < t->span_count; i++)
        if (t->spans[i].asked[r] < least)
            least = t->spans[i].asked[r];
    return least;
}

/* Step 1. */
static void learn(struct naive_manager *n, struct naive_texture *t, const uint8_t *asked)
{
    uint32_t returns = 0;
    if (!t->known)
        return;
    for (uint32_t r = 0; r < count_regions(t); r++) {
        const uint8_t known = t->known[r];
        if (known == NOTHING || asked[r] > known)
            continue;
        if (t->last_asked[r] == known)
            t->hits++;
        else
            returns++;
    }
    t->returns += returns;
    n->events[NAIVE_RETURNS] += returns > 0 && n->config.missesToExpire == 0;
    const uint64_t regions = count_regions(t);
    if (t->hits + t->returns >= (regions > 2048 ? 2 * regions : 4096)) {
        t->hits /= 2;
        t->returns /= 2;
        for (uint32_t r = 0; r < count_regions(t); r++)
            t->known[r] = least_of(t, r);
    }
}

static void note_known(struct naive_texture *t, const uint8_t *asked)
{
    if (!t->known)
        t->known = memset(naive_alloc(count_regions(t), 1), NOTHING, count_regions(t));
    for (uint32_t r = 0; r < count_regions(t); r++)
        if (asked[r] < t->known[r])
            t->known[r] = asked[r];
}

static uint64_t add_weights(uint64_t a, uint64_t b)
{
    return a + b < MAX_WEIGHT ? a + b : MAX_WEIGHT;
}

/* Step 2. */
static uint64_t absence_after(const struct naive_texture *t, const uint8_t *asked)
{
    uint64_t holding = 0;
    for (uint32_t r = 0; r < count_regions(t); r++) {
        if (asked[r] != NOTHING)
            return 0;
        holding += least_of(t, r) != NOTHING;
    }
    return add_weights(t->absence, holding ? holding : 1);
}

/* Step 3. */
static uint64_t misses_needed(const struct naive_manager *n, const struct naive_texture *t)
{
    if (n->config.missesToExpire)
        return n->config.missesToExpire;
    if (!t->returns)
        return 1;
    const uint64_t needed = (uint64_t)14 * t->returns / (t->hits + 1) + 7;
    return needed < 4096 ? needed : 4096;
}

/* Returns -1 if the tile's size is not the region's times a power of two. */
static int log2_ratio(uint32_t tile, uint32_t region)
{
    for (int s = 0; s < 32; s++)
        if ((uint64_t)region << s == tile)
            return s;
    return -1;
}

static uint32_t regions_per_tile_log2(const SluiceStreamedTextureDesc *d)
{
    const int x = log2_ratio(d->tileWidth, d->feedbackRegionWidth);
    const int y = log2_ratio(d->tileHeight, d->feedbackRegionHeight);
    if (x < 0 || y < 0)
        return 0;
    const int least = x < y ? x : y;
    return least < 8 ? (uint32_t)least : 8;
}

static uint32_t level_to_delete(uint64_t needed, uint32_t s, uint64_t newer)
{
    uint32_t k = 0;
    while ((2 * (k + s) < 64 ? needed >> (2 * (k + s)) : 0) > newer)
        k++;
    return k;
}

bool naive_would_believe(const struct naive_manager *n, const struct naive_texture *t,
                         uint64_t misses, uint32_t level)
{
    const uint32_t s = regions_per_tile_log2(&t->layout.desc);
    return level_to_delete(misses_needed(n, t), s, misses) <= level;
}

/* Returns whether no level is left. */
static bool delete_levels(struct naive_manager *n, const struct naive_texture *t,
                          struct naive_span *span, uint32_t below)
{
    bool deleted = false, left = false;
    for (uint32_t r = 0; r < count_regions(t); r++) {
        if (span->asked[r] == NOTHING)
            continue;
        if (span->asked[r] >= below) {
            span->asked[r] = NOTHING;
            deleted = true;
        } else
            left = true;
    }
    n->events[NAIVE_SPAN_THINNED] += deleted && left;
    return !left;
}

/* Step 4. */
static void let_lapse(struct naive_manager *n, struct naive_texture *t, uint64_t needed,
                      uint64_t now, uint64_t timeout)
{
    const uint32_t s = regions_per_tile_log2(&t->layout.desc);
    bool over_and_empty[NAIVE_MAX_SPANS] = {false};
    for (uint32_t i = 0; i < t->span_count; i++) {
        struct naive_span *span = &t->spans[i];
        const uint64_t age = now - span->end;
        uint64_t newer = 1;
        for (uint32_t k = i + 1; k < t->span_count; k++)
            newer = add_weights(newer, t->spans[k].weight);
        newer = max_u64(newer, t->absence);
        if (age >= timeout)
            over_and_empty[i] = delete_levels(n, t, span, level_to_delete(needed, s, newer));
    }
    uint32_t deleted = 0;
    while (deleted < NAIVE_MAX_SPANS && over_and_empty[deleted])
        deleted++;
    for (uint32_t i = deleted; i > 0; i--)
        delete_span(t, 0);
}

/* Step 5. */
static void join(struct naive_manager *n, struct naive_texture *t, const uint8_t *asked,
                 uint64_t needed, uint64_t now, uint64_t timeout)
{
    struct naive_span *newest = t->span_count ? &t->spans[t->span_count - 1] : NULL;
    n->events[NAIVE_SPANS_FULL] += t->span_count == NAIVE_MAX_SPANS;
    if (newest && (t->span_count == NAIVE_MAX_SPANS || now - newest->begin < timeout / 4 ||
                   max_u64(newest->weight, t->absence) < needed / 4)) {
        newest->end = now;
        newest->weight = add_weights(newest->weight, 1);
        for (uint32_t r = 0; r < count_regions(t); r++)
            if (asked[r] < newest->asked[r])
                newest->asked[r] = asked[r];
        return;
    }
    const uint32_t regions = count_regions(t);
    t->spans[t->span_count++] = (struct naive_span){
        .begin = now,
        .end = now,
        .weight = 1,
        .asked = memcpy(naive_alloc(regions, 1), asked, regions),
    };
}

void naive_remember(struct naive_manager *n, struct naive_texture *t, const uint8_t *asked,
                    uint64_t time, uint64_t timeout)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    const uint32_t coarsest = l->desc.mipLevelCount - 1;
    learn(n, t, asked);
    note_known(t, asked);
    t->absence = absence_after(t, asked);
    const uint64_t needed = misses_needed(n, t);
    let_lapse(n, t, needed, time, timeout);
    join(n, t, asked, needed, time, timeout);
    for (uint32_t r = 0; r < count_regions(t); r++) {
        const uint8_t least = least_of(t, r);
        const uint32_t level =
            least + naive_region_bias(n, t, r % l->feedbackWidth, r / l->feedbackWidth);
        t->held[r] = least == NOTHING ? NOTHING : (uint8_t)(level < coarsest ? level : coarsest);
    }
}
