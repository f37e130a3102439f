#include "core/prefetch.h"

#include "core/eviction.h"
#include "core/history.h"
#include "core/texture_tiles.h"
#include "residency/nodes.h"

/** Most textures that one call examines for tiles to prefetch. */
enum { MAX_LOOKED_AT = 256 };

static bool may_prefetch(const slc_manager *m)
{
    uint32_t kept = m->residency.standby.count +
                    slc_count_with_slots(&m->residency, SLUICE_TILE_STATE_CANCELED);
    return kept < m->config.numExtraStandbyTiles &&
           m->residency.heaps.free_total > slc_kept_slots(m);
}

/**
 * Hands out FREE tiles of a level. Any result but SUCCESS ends prefetching: BUDGET_REACHED if no
 * more tiles may be prefetched, INCOMPLETE if the list is full.
 */
static SluiceResult prefetch_level(slc_manager *m, struct slc_managed_texture *t, uint32_t level,
                                   uint32_t room, uint32_t *written, SluiceTile *tiles)
{
    const struct slc_level *grid = &t->shape->levels[level];
    uint32_t end = grid->first_tile + grid->width * grid->height;
    for (uint32_t tile = grid->first_tile; tile < end; tile++) {
        if (slc_find_node(t, tile))
            continue;
        if (*written == room)
            return SLUICE_INCOMPLETE;
        if (!may_prefetch(m))
            return SLUICE_BUDGET_REACHED;
        if (!slc_reserve_nodes(&m->residency, 1) || slc_state_make(m, t) != SLUICE_SUCCESS) {
            slc_state_release(m, t); /* half made */
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        }
        uint32_t node = slc_tile_prefetch(m, t, tile, level);
        slc_take_own_slot(m, node);
        tiles[(*written)++] = slc_node_tile(m, node);
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_prefetch(slc_manager *m, uint32_t room, uint32_t *written, SluiceTile *tiles)
{
    uint32_t level_before = m->prefetch_level, texture_before = m->prefetch_texture;
    m->events.reason = SLUICE_TILE_EVENT_PREFETCHED;
    for (uint32_t i = 0; i < MAX_LOOKED_AT && i < m->texture_end; i++) {
        if (m->prefetch_texture >= m->texture_end) {
            m->prefetch_texture = 0;
            m->prefetch_level++;
        }
        if (m->prefetch_level >= m->config.prefetchLevels)
            m->prefetch_level = 0;
        struct slc_managed_texture *t = slc_texture_at(m, m->prefetch_texture);
        uint32_t levels = t->live ? t->shape->desc.regularMipCount : 0;
        if (m->prefetch_level < levels) {
            SluiceResult result =
                prefetch_level(m, t, levels - 1 - m->prefetch_level, room, written, tiles);
            if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY && *written == 0) {
                m->prefetch_level = level_before;
                m->prefetch_texture = texture_before;
                return result;
            }
            m->cut_short = result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
            if (result != SLUICE_SUCCESS)
                return result == SLUICE_BUDGET_REACHED ? SLUICE_SUCCESS : SLUICE_INCOMPLETE;
        }
        m->prefetch_texture++;
    }
    return SLUICE_SUCCESS;
}
