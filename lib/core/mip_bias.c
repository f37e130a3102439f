#include "core/mip_bias.h"

#include "base/bytes.h"
#include "base/checked.h"
#include "core/history.h"

#include <string.h>

/*
 * While more tiles are wanted than there can be slots, every region of every texture gets a coarser
 * level than it requests. The bias counts in sixteenths of a level. An ordered dither over blocks
 * of regions and over textures turns the fraction into whole levels, so that the demand follows the
 * bias smoothly. A change applies to a texture when its next map comes, so the bias rests until
 * every texture has had a map.
 *
 * A step down can be far too much: with a single texture, its only block of regions becomes a whole
 * level finer. So a value that failed is not tried again until something has changed.
 */

enum { STEPS = 16, BLOCK = 8, MAX_BIAS = SLC_MAX_MIP_BIAS, OVERCOMMIT_HALVES = 7 };

/** PATIENCE: most rounds to wait for maps that are due. Trials: of values that failed before. */
enum { PATIENCE = 16, MAX_TRIALS = SLC_MAX_BIAS_TRIALS, TRIAL_PERIODS = 8 };

static uint8_t dither(uint32_t texture, uint32_t x, uint32_t y)
{
    static const uint8_t thresholds[4][4] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    return (uint8_t)((thresholds[y % 4][x % 4] + 7 * texture) % STEPS);
}

void slc_bias_map(const slc_manager *m, const struct slc_managed_texture *t, uint8_t *map)
{
    uint8_t whole = (uint8_t)(m->bias.value / STEPS), part = (uint8_t)(m->bias.value % STEPS);
    memset(map, whole, slc_padded(slc_region_count(t)));
    if (part == 0)
        return;
    for (uint32_t y = 0; y < t->shape->feedback_height; y++) {
        uint8_t *row = map + (size_t)y * t->shape->feedback_width;
        for (uint32_t x = 0; x < t->shape->feedback_width; x += BLOCK)
            if (dither(t->index, x / BLOCK, y / BLOCK) < part)
                memset(row + x, whole + 1, slc_min_u32(BLOCK, t->shape->feedback_width - x));
    }
}

uint64_t slc_slot_limit(const slc_manager *m)
{
    uint64_t heaps = m->config.maxHeapCount ? m->config.maxHeapCount : UINT32_MAX;
    /* a refusal without any heap says nothing about the limit */
    if (m->refused && m->residency.heaps.live_count > 0 && m->residency.heaps.live_count < heaps)
        heaps = m->residency.heaps.live_count;
    return heaps * m->residency.heaps.capacity * OVERCOMMIT_HALVES / 2;
}

static void change(slc_manager *m)
{
    m->bias.epoch++;
    m->bias.behind = m->visited_count;
    m->bias.rounds = 0;
}

/** Raises the bias. `failed`: more tiles are surely wanted than the present value allows. */
static void raise_bias(slc_manager *m, uint64_t wanted, uint64_t limit, bool failed)
{
    struct slc_global_bias *b = &m->bias;
    uint32_t before = b->value;
    if (failed) {
        b->trials += b->value < b->floor && b->trials < MAX_TRIALS;
        b->floor = b->value + 1;
        b->failed_limit = limit;
        b->changed = false;
    }
    b->demand = 0;
    b->waited = 0;
    /* A level is a factor of 4 in tiles: a step is one of 4^(1/16). */
    for (uint32_t step = 0; step < STEPS && wanted > limit && b->value < MAX_BIAS; step++) {
        wanted = wanted * 60097 / 65536;
        b->value++;
    }
    b->raised = true;
    if (b->value != before)
        change(m);
}

/**
 * Whether a value that failed may fit by now. It cannot if nothing has changed, so that a still
 * scene comes to rest. Each trial that fails doubles the time to the next one.
 */
static bool may_try_again(const struct slc_global_bias *b, uint64_t wanted, uint64_t limit)
{
    if (b->waited < (UINT32_C(1) << b->trials) - 1)
        return false;
    if (limit > b->failed_limit)
        return true;
    /* `demand` may be of a later scene than the failure. In any scene, a value may be tried if a
     * whole level finer fits: four times as many tiles. */
    return b->changed && (wanted * 4 <= limit || wanted + wanted / 8 <= b->demand);
}

static bool may_lower(const struct slc_global_bias *b, uint64_t wanted, uint64_t limit)
{
    if (wanted + wanted / 8 > limit)
        return false;
    return b->value > b->floor || may_try_again(b, wanted, limit);
}

static void count_round(struct slc_global_bias *b)
{
    b->maps = 0;
    b->rounds += b->rounds < UINT32_MAX;
    b->waited += b->waited < UINT32_MAX;
    if (b->waited >> b->trials >= TRIAL_PERIODS)
        b->trials = 0;
}

static void turn_off(slc_manager *m)
{
    if (m->bias.value == 0)
        return;
    m->bias.value = 0;
    m->bias.raised = false;
    change(m);
}

/*
 * Textures that got no map since the last change still want the tiles of the bias before it: too
 * many after a raise, too few after a step down. So the number of wanted tiles is a bound. If the
 * bound does not decide, the function waits for the maps that are due, at most PATIENCE rounds.
 */
void slc_update_bias(slc_manager *m, uint64_t limit)
{
    struct slc_global_bias *b = &m->bias;
    if (m->config.noMipBias) {
        turn_off(m);
        return;
    }
    uint64_t wanted = (uint64_t)slc_count_with_slots(&m->residency, SLUICE_TILE_STATE_REQUESTED) +
                      slc_count_with_slots(&m->residency, SLUICE_TILE_STATE_ALLOCATED) +
                      slc_count_with_slots(&m->residency, SLUICE_TILE_STATE_MAPPED) +
                      m->residency.evicted_wanted;
    if ((b->value == 0 && wanted <= limit) || b->maps < m->visited_count)
        return;
    count_round(b);
    bool known = b->behind == 0, may_wait = !known && b->rounds < PATIENCE;
    if (wanted > limit) {
        if (!b->raised || !may_wait)
            raise_bias(m, wanted, limit, known || !b->raised);
        return;
    }
    if (may_wait)
        return;
    if (b->demand == 0)
        b->demand = wanted;
    if (!may_lower(b, wanted, limit))
        return;
    b->value--;
    b->raised = false;
    change(m);
}
