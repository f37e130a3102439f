/* Tiles that were given up are tried again: docs/manager-specification.md, "Loads that fail". */
#include "core/naive_manager.h"

#include <stdlib.h>

/* 0: never. */
static uint64_t retry_interval(const struct naive_manager *n)
{
    const uint64_t most = (uint64_t)1 << 62;
    if (n->config.givenUpRetryDelayTicks == UINT64_MAX)
        return 0;
    if (n->config.givenUpRetryDelayTicks)
        return n->config.givenUpRetryDelayTicks;
    return n->config.retryDelayTicks > most / 120 - 1 ? most : 120 * n->config.retryDelayTicks;
}

static void enter(struct naive_manager *n, struct naive_texture *t, enum naive_trouble trouble)
{
    t->trouble = trouble;
    t->trouble_since = ++n->stamp;
    t->trouble_time = n->time;
}

static uint32_t count_in(const struct naive_manager *n, enum naive_trouble trouble)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < n->texture_room; i++)
        count += n->textures[i] && n->textures[i]->trouble == trouble;
    return count;
}

/* The one that entered the state first, or NULL. */
static struct naive_texture *first_in(const struct naive_manager *n, enum naive_trouble trouble)
{
    struct naive_texture *first = NULL;
    for (uint32_t i = 0; i < n->texture_room; i++) {
        struct naive_texture *t = n->textures[i];
        if (t && t->trouble == trouble && (!first || t->trouble_since < first->trouble_since))
            first = t;
    }
    return first;
}

static bool is_due(const struct naive_manager *n, const struct naive_texture *t)
{
    return t && n->time - t->trouble_time >= retry_interval(n);
}

/* Returns how many were requested. */
static uint32_t request_tiles(struct naive_manager *n, struct naive_texture *t, uint32_t most)
{
    uint32_t count;
    struct naive_ref *refs = naive_collect(n, t, SLUICE_TILE_STATE_GIVEN_UP, &count);
    for (uint32_t i = 0; i < count; i++)
        refs[i].key[0] = refs[i].tile->given_up_at;
    naive_sort(refs, count);
    uint32_t requested = 0;
    while (requested < count && (requested < most || refs[requested].tile->packed))
        naive_request(n, refs[requested++].tile, 0);
    free(refs);
    n->totals.givenUpRetriedTotal += requested;
    return requested;
}

void naive_probe_given_up(struct naive_manager *n)
{
    struct naive_texture *t;
    if (retry_interval(n) == 0)
        return;
    while (is_due(n, t = first_in(n, NAIVE_TROUBLE_PROBED)))
        enter(n, t, NAIVE_TROUBLE_RESTING);
    while (is_due(n, t = first_in(n, NAIVE_TROUBLE_RESTING)))
        enter(n, t, NAIVE_TROUBLE_DUE);
    while (count_in(n, NAIVE_TROUBLE_PROBED) < 16 && (t = first_in(n, NAIVE_TROUBLE_DUE))) {
        t->retried_all = false;
        enter(n, t, NAIVE_TROUBLE_PROBED);
        if (request_tiles(n, t, 4) == 0)
            t->trouble = NAIVE_TROUBLE_NONE;
        else
            n->events[NAIVE_PROBED]++;
    }
}

void naive_note_given_up(struct naive_manager *n, struct naive_texture *t)
{
    if (t->trouble == NAIVE_TROUBLE_NONE || t->trouble == NAIVE_TROUBLE_PROBED)
        enter(n, t, NAIVE_TROUBLE_RESTING);
}

void naive_note_success(struct naive_manager *n, struct naive_texture *t, bool had_failed)
{
    uint32_t count;
    free(naive_collect(n, t, SLUICE_TILE_STATE_GIVEN_UP, &count));
    if (count == 0 || retry_interval(n) == 0)
        return;
    if (had_failed && !t->retried_all) {
        request_tiles(n, t, UINT32_MAX);
        t->trouble = NAIVE_TROUBLE_NONE;
        t->retried_all = true;
        n->events[NAIVE_RETRIED_ALL]++;
    } else if (t->trouble == NAIVE_TROUBLE_RESTING &&
               n->time - t->trouble_time >= retry_interval(n) / 8) {
        enter(n, t, NAIVE_TROUBLE_DUE);
        n->events[NAIVE_PROBED_EARLY]++;
    }
}
