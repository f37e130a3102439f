/* The section "The global bias". */
#include "core/naive_manager.h"

#include <stdlib.h>

#define MAX_BIAS 320u

uint32_t naive_region_bias(const struct naive_manager *n, const struct naive_texture *t,
                           uint32_t rx, uint32_t ry)
{
    static const uint32_t matrix[4][4] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    const uint64_t index = (uint32_t)t->id;
    const uint64_t threshold = (matrix[ry / 8 % 4][rx / 8 % 4] + 7 * index) % 16;
    return n->bias.value / 16 + (threshold < n->bias.value % 16);
}

/* UINT64_MAX: none. */
static uint64_t wanted_limit(const struct naive_manager *n)
{
    uint64_t heaps = n->config.maxHeapCount ? n->config.maxHeapCount : UINT64_MAX;
    if (n->heap_refused && n->heap_count > 0 && n->heap_count < heaps)
        heaps = n->heap_count;
    return heaps == UINT64_MAX ? UINT64_MAX : 7 * heaps * n->capacity / 2;
}

static void fail(struct naive_manager *n, uint64_t limit)
{
    struct naive_bias *b = &n->bias;
    if (b->value < b->floor) {
        b->failed_trials = b->failed_trials < 12 ? b->failed_trials + 1 : 12;
        n->events[NAIVE_BIAS_FAILED_AGAIN]++;
    }
    b->floor = b->value + 1;
    b->failed_limit = limit;
    b->scene_changed = false;
}

static void raise_bias(struct naive_bias *b, uint64_t wanted, uint64_t limit)
{
    const uint32_t old = b->value;
    b->demand = 0;
    b->looks_since_raise = 0;
    b->went_up = true;
    for (int i = 0; i < 16 && wanted > limit && b->value < MAX_BIAS; i++) {
        b->value++;
        wanted = wanted * 60097 / 65536;
    }
    if (b->value > old) {
        b->changes++;
        b->looks_since_change = 0;
    }
}

static bool may_lower_bias(struct naive_manager *n, uint64_t wanted, uint64_t limit)
{
    const struct naive_bias *b = &n->bias;
    const uint64_t more = wanted + wanted / 8;
    if (more > limit)
        return false;
    if (b->value > b->floor)
        return true;
    if (b->looks_since_raise + 1 < UINT64_C(1) << b->failed_trials)
        return false;
    const bool smaller = b->scene_changed && (4 * wanted <= limit || more <= b->demand);
    n->events[NAIVE_BIAS_TRIED_AGAIN] += limit > b->failed_limit || smaller;
    return limit > b->failed_limit || smaller;
}

/* Returns whether all textures that hold a level were merged with the present bias. */
static bool demand_is_known(const struct naive_manager *n)
{
    for (uint32_t i = 0; i < n->texture_room; i++)
        if (n->textures[i] && naive_holds_anything(n->textures[i]) &&
            n->textures[i]->merged_bias_changes != n->bias.changes)
            return false;
    return true;
}

void naive_note_change(struct naive_manager *n, struct naive_texture *t, const uint8_t *before,
                       bool held_before)
{
    uint8_t *after = naive_alloc(t->layout.regularTileCount, 1);
    naive_wishes(t, t->held, after);
    bool differ = held_before != naive_holds_anything(t);
    for (uint32_t i = 0; i < t->layout.regularTileCount && t->tiles[i].level == 0; i++)
        differ |= t->merged_bias == n->bias.value && before[i] != after[i];
    n->bias.scene_changed |= differ;
    t->merged_bias = n->bias.value;
    t->merged_bias_changes = n->bias.changes;
    free(after);
}

static uint64_t count_evicted(const struct naive_manager *n)
{
    uint32_t standby;
    uint64_t evicted = 0;
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_STANDBY, &standby);
    for (uint32_t i = 0; i < standby; i++)
        evicted += refs[i].tile->wanted;
    free(refs);
    return evicted;
}

uint64_t naive_count_holding(const struct naive_manager *n)
{
    uint64_t holding = 0;
    for (uint32_t i = 0; i < n->texture_room; i++)
        holding += n->textures[i] && naive_holds_anything(n->textures[i]);
    return holding;
}

static uint64_t count_wanted(const struct naive_manager *n)
{
    static const SluiceTileState states[] = {SLUICE_TILE_STATE_REQUESTED,
                                             SLUICE_TILE_STATE_ALLOCATED, SLUICE_TILE_STATE_MAPPED};
    uint64_t wanted = count_evicted(n);
    for (size_t s = 0; s < sizeof states / sizeof *states; s++) {
        uint32_t count;
        struct naive_ref *refs = naive_collect(n, NULL, states[s], &count);
        for (uint32_t i = 0; i < count; i++)
            wanted += !refs[i].tile->outside;
        free(refs);
    }
    return wanted;
}

void naive_look_at_bias(struct naive_manager *n)
{
    struct naive_bias *b = &n->bias;
    if (n->config.noMipBias) {
        if (b->value > 0) {
            b->value = 0;
            b->changes++;
            b->looks_since_change = 0;
            b->went_up = false;
        }
        return;
    }
    const uint64_t holding = naive_count_holding(n);
    const uint64_t limit = wanted_limit(n);
    const uint64_t wanted = count_wanted(n);
    if ((b->value == 0 && wanted <= limit) || b->maps < holding)
        return;
    b->maps = 0;
    b->looks_since_change++;
    b->looks_since_raise++;
    if (b->looks_since_raise >= UINT64_C(8) << b->failed_trials)
        b->failed_trials = 0;
    const bool known = demand_is_known(n), overdue = b->looks_since_change >= 16;
    if (wanted > limit) {
        if (b->went_up && !known && !overdue) {
            n->events[NAIVE_BIAS_WAITED]++;
            return;
        }
        if (known || !b->went_up)
            fail(n, limit);
        raise_bias(b, wanted, limit);
        return;
    }
    if (!known && !overdue) {
        n->events[NAIVE_BIAS_WAITED]++;
        return;
    }
    if (b->demand == 0)
        b->demand = wanted;
    if (may_lower_bias(n, wanted, limit)) {
        b->value--;
        b->changes++;
        b->looks_since_change = 0;
        b->went_up = false;
        n->events[NAIVE_BIAS_LOWERED]++;
    }
}
