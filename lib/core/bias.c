#include "core/history.h"

#include "base/bytes.h"
#include "base/checked.h"

#include <string.h>

/*
 * When more tiles are wanted than there can be slots, every region of every texture wants a coarser
 * level than it asks for. The bias counts in sixteenths of a level: an ordered dither over blocks
 * of regions and over textures turns the fraction into whole levels, so that the demand follows the
 * bias smoothly. A change works on a texture when its next map comes, so the bias rests until every
 * texture has had a map.
 */

enum { STEPS = 16, BLOCK = 8, MAX_BIAS = 20 * STEPS, OVERCOMMIT_HALVES = 7 };

static uint8_t dither(uint32_t texture, uint32_t x, uint32_t y)
{
    static const uint8_t thresholds[4][4] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    return (uint8_t)((thresholds[y % 4][x % 4] + 7 * texture) % STEPS);
}

void slc_bias_map(const slc_manager *m, const struct slc_texture *t, uint8_t *map)
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
    /* no heap at all says nothing yet */
    if (m->refused && m->heaps.live_count > 0 && m->heaps.live_count < heaps)
        heaps = m->heaps.live_count;
    return heaps * m->heaps.capacity * OVERCOMMIT_HALVES / 2;
}

static void raise_bias(slc_manager *m, uint64_t wanted, uint64_t limit)
{
    m->bias.failed = m->bias.value;
    m->bias.failed_limit = limit;
    m->bias.demand = 0;
    /* A level is a factor of 4 in tiles: a step is one of 4^(1/16). */
    for (uint32_t step = 0; step < STEPS && wanted > limit && m->bias.value < MAX_BIAS; step++) {
        wanted = wanted * 60097 / 65536;
        m->bias.value++;
    }
}

/**
 * A step down that was too far before is tried again only if something is different. It surely is
 * where a whole level finer would fit, which is four times as many tiles.
 */
static bool may_lower(slc_manager *m, uint64_t wanted, uint64_t limit)
{
    if (wanted * 4 <= limit)
        return true;
    if (wanted + wanted / 8 > limit)
        return false;
    if (m->bias.value - 1 > m->bias.failed || limit > m->bias.failed_limit)
        return true;
    return wanted + wanted / 8 <= m->bias.demand;
}

void slc_update_bias(slc_manager *m, uint64_t limit)
{
    uint64_t wanted = (uint64_t)m->state_counts[SLUICE_TILE_STATE_REQUESTED] +
                      m->state_counts[SLUICE_TILE_STATE_ALLOCATED] +
                      m->state_counts[SLUICE_TILE_STATE_MAPPED] + m->displaced;
    if ((m->bias.value == 0 && wanted <= limit) || m->bias.maps < m->visited_count)
        return;
    m->bias.maps = 0;
    if (wanted > limit) {
        raise_bias(m, wanted, limit);
        return;
    }
    if (m->bias.demand == 0)
        m->bias.demand = wanted;
    if (may_lower(m, wanted, limit))
        m->bias.value--;
}
