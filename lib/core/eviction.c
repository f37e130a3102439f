/*
 * Eviction order when requests have no slots: first STANDBY tiles, then tiles of textures that get
 * no maps any more, then wanted tiles that are worth less than the requests. Evicted tiles are
 * listed for unmapping; sluiceGetTilesToUnmap hands them out.
 */
#include "core/eviction.h"

#include "base/checked.h"
#include "core/history.h"
#include "core/observer.h"
#include "core/priority.h"
#include "core/wants.h"
#include "residency/node.h"
#include "residency/node_list.h"
#include "residency/standby.h"

static bool is_idle(const slc_manager *m, const struct slc_managed_texture *t)
{
    uint64_t age = m->time - t->map_time, usual = m->map_interval;
    usual = t->interval > usual ? t->interval : usual;
    usual = t->timeout > usual ? t->timeout : usual;
    return age > 0 && age / (t->interval ? 4 : 16) >= usual; /* 16: no interval is known yet */
}

uint64_t slc_surplus_slots(const slc_manager *m)
{
    uint32_t target = m->config.targetHeapCount, count = m->residency.heaps.live_count;
    return target && count > target ? (uint64_t)(count - target) * m->residency.heaps.capacity : 0;
}

uint64_t slc_kept_slots(const slc_manager *m)
{
    return slc_tile_heaps_reserved(&m->residency.heaps) + slc_surplus_slots(m);
}

bool slc_has_own_slot(const slc_manager *m)
{
    const struct slc_tile_heaps *heaps = &m->residency.heaps;
    return heaps->free_total > heaps->packed_free || (heaps->packed_free && slc_surplus_slots(m));
}

bool slc_take_own_slot(slc_manager *m, uint32_t node)
{
    struct slc_tile_heaps *heaps = &m->residency.heaps;
    struct slc_node *n = slc_node_at(&m->residency, node);
    if (heaps->packed_free && slc_surplus_slots(m))
        return slc_tile_heaps_take_packed(heaps, node, &n->heap, &n->slot);
    return slc_tile_heaps_take(heaps, node, &n->heap, &n->slot);
}

/** Most tiles that one call examines to find unseen ones. */
enum { MAX_LOOKED_FOR = 1024 };

/** State of the search for victims. Each tile is examined once. */
struct eviction {
    uint32_t looks;                       ///< tiles that may still be examined
    uint32_t compares;                    ///< priorities that may still be compared
    uint32_t left[SLUICE_MAX_MIP_LEVELS]; ///< tiles of m->residency.mapped not examined yet
};

static struct eviction begin_eviction(const slc_manager *m)
{
    struct eviction d = {.looks = MAX_LOOKED_FOR, .compares = MAX_LOOKED_FOR};
    for (uint32_t l = 0; l < SLUICE_MAX_MIP_LEVELS; l++)
        d.left[l] = m->residency.mapped[l].count;
    return d;
}

/**
 * Finds a wanted tile of a level below `end` that the last map does not show; 0 if none is found.
 * Tiles that the map shows go to the end of their list, so that later calls examine other ones.
 */
static uint32_t unseen_mapped(slc_manager *m, struct eviction *d, uint32_t end)
{
    for (uint32_t l = 0; l < end && l < SLUICE_MAX_MIP_LEVELS; l++)
        for (struct slc_list *list = &m->residency.mapped[l]; d->left[l] && d->looks; d->looks--) {
            uint32_t node = list->head;
            d->left[l]--;
            if (!slc_is_seen(m, node))
                return node;
            slc_list_remove(&m->residency, list, node);
            slc_list_append(&m->residency, list, node);
        }
    return 0;
}

static int32_t priority_of(const slc_manager *m, uint32_t node)
{
    return slc_priority_of(m, slc_texture_at(m, slc_node_at(&m->residency, node)->owner));
}

/** Number of tiles at the head of a list that are compared by priority. */
enum { MAX_COMPARED = 64 };

/** Finds the first tile of the least priority among the first MAX_COMPARED tiles of a list. */
static uint32_t least_of(const slc_manager *m, const struct slc_list *list)
{
    uint32_t least = list->head, node = list->head;
    for (uint32_t i = 0; i < MAX_COMPARED && node && slc_has_priorities(m); i++) {
        if (priority_of(m, node) < priority_of(m, least))
            least = node;
        node = slc_node_at(&m->residency, node)->next;
    }
    return least;
}

/** Finds the finest wanted tile of a level below `end`, the first in its list; 0 if there is none.
 */
static uint32_t finest_mapped(const slc_manager *m, uint32_t end)
{
    for (uint32_t l = 0; l < end && l < SLUICE_MAX_MIP_LEVELS; l++)
        if (m->residency.mapped[l].head)
            return least_of(m, &m->residency.mapped[l]);
    return 0;
}

/** Finds the finest wanted tile of less priority than the request, and of its level or a finer one.
 */
static uint32_t minor_mapped(slc_manager *m, struct eviction *d, uint32_t request)
{
    const struct slc_node *n = slc_node_at(&m->residency, request);
    int32_t priority = priority_of(m, request);
    for (uint32_t l = 0; l <= n->level && slc_has_priorities(m); l++) {
        struct slc_list *list = &m->residency.mapped[l];
        for (uint32_t left = list->count; left && d->compares; left--, d->compares--) {
            uint32_t node = list->head;
            if (priority_of(m, node) < priority)
                return node;
            slc_list_remove(&m->residency, list, node);
            slc_list_append(&m->residency, list, node);
        }
    }
    return 0;
}

static void evict_wanted(slc_manager *m, struct eviction *d, uint32_t node)
{
    uint32_t level = slc_node_at(&m->residency, node)->level;
    slc_node_evict_wanted(&m->residency, node);
    d->left[level] = slc_min_u32(d->left[level], m->residency.mapped[level].count);
}

/** Finds a wanted tile to evict for the request; 0 if there is none. */
static uint32_t victim_for(slc_manager *m, struct eviction *d, uint32_t request)
{
    const struct slc_node *n = slc_node_at(&m->residency, request);
    if (slc_is_packed_class(n->level))
        return finest_mapped(m, SLUICE_MAX_MIP_LEVELS);
    bool waited = n->order < m->round.waited, waited_long = n->order < m->round.waited_long;
    uint32_t node = unseen_mapped(m, d, n->level + waited);
    uint32_t gap = waited_long ? 0 : waited ? 1 : 2;
    if (!node && n->level > gap)
        node = finest_mapped(m, n->level - gap);
    return node ? node : minor_mapped(m, d, request);
}

/**
 * Wanted tiles are evicted for coarser requests. Otherwise early textures would stay sharp, and
 * later ones would never be loaded. The exchange ends: each one loads a coarser tile, or evicts a
 * tile that the last map does not show. A tile that the map shows is evicted for a request one or
 * two levels coarser only if the request has waited for rounds of maps: the upload costs more.
 */
void slc_evict_wanted_for(slc_manager *m, struct slc_request_walk walk, uint32_t unserved)
{
    struct eviction d = begin_eviction(m);
    m->events.reason = SLUICE_TILE_EVENT_EVICTED;
    uint64_t coming = slc_coming_slots(&m->residency);
    uint64_t reserved = slc_kept_slots(m), free_slots = m->residency.heaps.free_total;
    for (; free_slots + coming < reserved; coming++) {
        uint32_t victim = finest_mapped(m, SLUICE_MAX_MIP_LEVELS);
        if (!victim)
            return;
        evict_wanted(m, &d, victim);
    }
    coming -= free_slots < reserved ? reserved - free_slots : 0;
    for (uint32_t passed = 0; walk.node && unserved && passed < SLC_MAX_PASSED_OVER; passed++) {
        if (slc_is_asked_for(m, walk.node)) {
            unserved--;
            uint32_t victim = coming ? 0 : victim_for(m, &d, walk.node);
            if (!coming && !victim)
                return;
            if (victim)
                evict_wanted(m, &d, victim);
            coming -= coming > 0;
        }
        slc_walk_on(m, &walk);
    }
}

/**
 * Makes room for `unserved` requests: evicts STANDBY tiles and drops the requests of idle textures.
 * Returns whether a texture was dropped, which ends its requests.
 */
bool slc_evict_unwanted_for(slc_manager *m, uint32_t unserved)
{
    uint64_t needed = unserved, reserved = slc_kept_slots(m);
    bool dropped = false;
    m->events.reason = SLUICE_TILE_EVENT_EVICTED;
    if (reserved > m->residency.heaps.free_total)
        needed += reserved - m->residency.heaps.free_total;
    while (slc_coming_slots(&m->residency) + m->residency.standby.count < needed &&
           m->visit_first != SLC_NONE && is_idle(m, slc_texture_at(m, m->visit_first))) {
        slc_wants_drop(m, slc_texture_at(m, m->visit_first));
        dropped = true;
    }
    uint64_t coming = slc_coming_slots(&m->residency);
    uint64_t take = needed > coming ? needed - coming : 0;
    slc_evict_standby(&m->residency, m->residency.standby.count > take
                                         ? m->residency.standby.count - (uint32_t)take
                                         : 0);
    return dropped;
}

SluiceResult sluiceTrimStandbyTiles(SluiceStreamedTextureManager *manager, uint32_t keepTileCount)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    slc_evict_standby(&manager->residency, keepTileCount);
    struct slc_call call = {.kind = SLC_CALL_TRIM_STANDBY, .keep_count = keepTileCount};
    slc_notify(manager, &call);
    return SLUICE_SUCCESS;
}
