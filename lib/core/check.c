#include "core/check.h"

#include "core/follower.h"
#include "core/layout.h"
#include "core/reports.h"
#include "core/texture_tiles.h"
#include "residency/due.h"

/* Each function returns NULL or the first condition that is false. */
#define REQUIRE(condition)                                                                         \
    do {                                                                                           \
        if (!(condition))                                                                          \
            return #condition;                                                                     \
    } while (0)

static bool has_slot(uint8_t state)
{
    return state == SLUICE_TILE_STATE_ALLOCATED || state == SLUICE_TILE_STATE_CANCELED ||
           state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY ||
           state == SLC_NODE_RETIRING;
}

static const char *check_list(const slc_manager *m, const struct slc_list *list, uint8_t state)
{
    uint32_t count = 0, previous = 0;
    for (uint32_t node = list->head; node; node = slc_node_at(&m->residency, node)->next) {
        REQUIRE(slc_node_at(&m->residency, node)->prev == previous);
        REQUIRE(slc_node_at(&m->residency, node)->state == state);
        REQUIRE(count < m->residency.node_end);
        previous = node;
        count++;
    }
    REQUIRE(list->tail == previous);
    REQUIRE(list->count == count);
    return NULL;
}

static const char *check_requests(const slc_manager *m)
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < SLC_REQUEST_CLASSES; c++) {
        REQUIRE((m->residency.requests.needs[c] != 0) == (m->residency.requests.classes >> c & 1));
        for (uint32_t d = 0; d < SLC_REQUEST_NEEDS; d++) {
            const struct slc_list *list = &m->residency.requests.lists[c][d];
            const char *wrong = check_list(m, list, SLUICE_TILE_STATE_REQUESTED);
            if (wrong)
                return wrong;
            REQUIRE((list->count > 0) == (m->residency.requests.needs[c] >> d & 1));
            count += list->count;
        }
    }
    REQUIRE(count == m->residency.requests.count);
    REQUIRE(count == m->residency.state_counts[SLUICE_TILE_STATE_REQUESTED]);
    return NULL;
}

static const char *check_lists(const slc_manager *m)
{
    const struct {
        const struct slc_list *list;
        uint8_t state;
    } lists[] = {
        {&m->residency.standby, SLUICE_TILE_STATE_STANDBY},
        {&m->residency.standby_outside, SLUICE_TILE_STATE_STANDBY},
        {&m->residency.evicted, SLUICE_TILE_STATE_STANDBY},
        {&m->residency.canceled, SLUICE_TILE_STATE_CANCELED},
        {&m->residency.given_up, SLUICE_TILE_STATE_GIVEN_UP},
        {&m->residency.retiring, SLC_NODE_RETIRING},
    };
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        const char *wrong = check_list(m, lists[i].list, lists[i].state);
        if (wrong)
            return wrong;
    }
    uint64_t mapped = 0;
    for (uint32_t l = 0; l < SLUICE_MAX_MIP_LEVELS; l++) {
        const char *wrong = check_list(m, &m->residency.mapped[l], SLUICE_TILE_STATE_MAPPED);
        if (wrong)
            return wrong;
        mapped += m->residency.mapped[l].count;
    }
    REQUIRE(mapped <=
            m->residency.state_counts[SLUICE_TILE_STATE_MAPPED]); /* packed ones are in no list */
    uint32_t evicted_wanted = 0;
    for (uint32_t node = m->residency.evicted.head; node;
         node = slc_node_at(&m->residency, node)->next)
        evicted_wanted += (slc_node_at(&m->residency, node)->flags & SLC_NODE_WANTED) != 0;
    REQUIRE(evicted_wanted == m->residency.evicted_wanted);
    REQUIRE(m->residency.standby.count <= m->config.numExtraStandbyTiles);
    REQUIRE(m->residency.standby_outside.count <= m->config.numExtraStandbyTiles);
    REQUIRE(m->residency.standby.count + m->residency.standby_outside.count +
                m->residency.evicted.count ==
            m->residency.state_counts[SLUICE_TILE_STATE_STANDBY]);
    REQUIRE(m->residency.failed.count == m->residency.state_counts[SLUICE_TILE_STATE_FAILED]);
    if (slc_due_check(&m->residency))
        return slc_due_check(&m->residency);
    if (slc_reports_check(m))
        return slc_reports_check(m);
    REQUIRE(m->residency.given_up.count == m->residency.state_counts[SLUICE_TILE_STATE_GIVEN_UP]);
    return check_requests(m);
}

static uint8_t level_under(const struct slc_managed_texture *t, uint32_t tile)
{
    return t->history ? t->history->under[tile] : SLUICE_MIP_UNTOUCHED;
}

static const char *check_node(const slc_manager *m, const struct slc_managed_texture *t,
                              uint32_t node)
{
    const struct slc_node *n = slc_node_at(&m->residency, node);
    REQUIRE(n->owner == t->index);
    REQUIRE(n->tile < t->shape->tile_count);
    REQUIRE(slc_find_node(t, n->tile) == node);
    bool regular = n->tile < t->shape->regular_tile_count;
    REQUIRE(n->level == (regular ? slc_tile_place(t, n->tile).level : slc_packed_class(t)));
    REQUIRE(n->state != SLUICE_TILE_STATE_FREE && n->state != SLC_NODE_RETIRING);
    REQUIRE((has_slot(n->state) && n->level != SLC_OUTSIDE_CLASS) == (n->heap != SLC_NONE));
    if (n->heap != SLC_NONE)
        REQUIRE(m->residency.heaps.heaps[n->heap].nodes[n->slot] == node);
    bool wanted = n->state != SLUICE_TILE_STATE_STANDBY && n->state != SLUICE_TILE_STATE_CANCELED;
    if (n->flags & SLC_NODE_WANTED)
        wanted = true;
    if (n->tile < t->shape->regular_tile_count)
        REQUIRE(wanted == (level_under(t, n->tile) <= n->level));
    else
        REQUIRE(wanted == (m->info.alwaysMapPackedTiles || t->held_regions > 0));
    return NULL;
}

static bool is_resident(const struct slc_managed_texture *t, struct slc_place p)
{
    return t->nodes[slc_tile_index(t, p)] & SLC_RESIDENT;
}

/** True if a coarser tile over a regular one, or a packed one, is not resident. */
static bool is_hidden(const struct slc_managed_texture *t, uint32_t tile)
{
    struct slc_place p = slc_tile_place(t, tile);
    bool hidden = t->packed_resident < t->shape->desc.packedTileCount;
    while (++p.level < t->shape->desc.regularMipCount) {
        const struct slc_level *grid = &t->shape->levels[p.level];
        p.x = p.x / 2 < grid->width ? p.x / 2 : grid->width - 1;
        p.y = p.y / 2 < grid->height ? p.y / 2 : grid->height - 1;
        hidden = hidden || !is_resident(t, p);
    }
    return hidden;
}

static const char *check_resident(const struct slc_managed_texture *t)
{
    uint32_t resident = 0, hidden = 0, levels[SLUICE_MAX_MIP_LEVELS] = {0};
    uint32_t wanted = 0, wanted_levels[SLUICE_MAX_MIP_LEVELS] = {0};
    for (uint32_t i = 0; t->nodes && i < t->shape->regular_tile_count; i++) {
        uint32_t level = slc_tile_place(t, i).level;
        wanted_levels[level] += level_under(t, i) <= level;
        if (!(t->nodes[i] & SLC_RESIDENT))
            continue;
        resident++;
        hidden += is_hidden(t, i);
        levels[level]++;
    }
    for (uint32_t l = 0; t->nodes && l < t->shape->desc.regularMipCount; l++) {
        REQUIRE(*slc_resident_in_level(t, l) == levels[l]);
        REQUIRE(*slc_wanted_in_level(t, l) == wanted_levels[l]);
        wanted += wanted_levels[l];
    }
    REQUIRE(wanted == t->wanted_tiles);
    REQUIRE(resident == t->resident_tiles && hidden == t->hidden_tiles);
    return NULL;
}

static const char *check_texture(const slc_manager *m, const struct slc_managed_texture *t,
                                 uint64_t *nodes)
{
    uint32_t requested = 0, resident_packed = 0, count = 0;
    for (uint32_t tile = t->nodes ? 0 : t->shape->regular_tile_count; tile < t->shape->tile_count;
         tile++) {
        uint32_t node = slc_find_node(t, tile);
        if (!node)
            continue;
        const char *wrong = check_node(m, t, node);
        if (wrong)
            return wrong;
        uint8_t state = slc_node_at(&m->residency, node)->state;
        requested += state == SLUICE_TILE_STATE_REQUESTED;
        if (slc_node_at(&m->residency, node)->tile >= t->shape->regular_tile_count)
            resident_packed +=
                state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
        count++;
    }
    REQUIRE(requested == t->requested_count);
    REQUIRE(resident_packed == t->packed_resident);
    *nodes += count;
    REQUIRE(t->visited == (t->held_regions > 0));
    if (!t->nodes) {
        REQUIRE(t->held_regions == 0 && t->regular_nodes == 0);
        return NULL;
    }
    REQUIRE(t->held_regions > 0 || t->regular_nodes > 0);
    uint32_t with_node = 0;
    for (uint32_t i = 0; i < t->shape->regular_tile_count; i++) {
        with_node += t->nodes[i] != 0;
        if (level_under(t, i) <= slc_tile_place(t, i).level)
            REQUIRE(t->nodes[i] != 0);
    }
    for (uint32_t i = 0; i < t->shape->desc.packedTileCount; i++)
        with_node += t->packed_nodes[i] != 0;
    REQUIRE(with_node == count);
    return check_resident(t);
}

/** Checks the textures that share the history of `t`: they have got equal maps. */
static const char *check_users(const slc_manager *m, const struct slc_managed_texture *t)
{
    uint32_t users = 0;
    if (!t->history)
        return NULL;
    for (uint32_t i = 0; i < m->texture_end; i++) {
        const struct slc_managed_texture *other = slc_texture_at(m, i);
        if (!other->live || other->history != t->history)
            continue;
        users++;
        REQUIRE(slc_have_same_shape(t, other));
        REQUIRE(t->held_regions == other->held_regions);
        REQUIRE(t->hits == other->hits && t->returns == other->returns);
    }
    REQUIRE(users == t->history->users);
    REQUIRE(users == 1 || t->history->bias == 0); /* the dither depends on the texture */
    return NULL;
}

static const char *check_visited(const slc_manager *m)
{
    uint32_t count = 0, previous = SLC_NONE;
    for (uint32_t i = m->visit_first; i != SLC_NONE; i = slc_texture_at(m, i)->visit_next) {
        const struct slc_managed_texture *t = slc_texture_at(m, i);
        REQUIRE(t->live && t->visited && t->visit_prev == previous);
        REQUIRE(count < m->texture_count);
        previous = i;
        count++;
    }
    REQUIRE(previous == m->visit_last && count == m->visited_count);
    return NULL;
}

/** Heaps for packed tiles are in no bucket and not empty, and their free slots are counted. Returns
 *  their number, UINT32_MAX if something is wrong. */
static uint32_t count_packed_heaps(const struct slc_tile_heaps *h)
{
    uint64_t free_slots = 0;
    uint32_t count = 0, empty = 0;
    for (uint32_t i = 0; i < h->end; i++) {
        const struct slc_tile_heap *heap = &h->heaps[i];
        empty += heap->free_count == h->capacity;
        if (!heap->packed)
            continue;
        if (heap->loose || heap->free_count >= h->capacity ||
            (heap->free_count && i < h->packed_from))
            return UINT32_MAX;
        free_slots += heap->free_count;
        count++;
    }
    return free_slots == h->packed_free && empty == h->empty_count ? count : UINT32_MAX;
}

/** Every other live heap is in the bucket of its free slots, or loose. The open heap has the fewest
 * free slots. */
static const char *check_buckets(const struct slc_tile_heaps *h)
{
    uint32_t count = 0, fewest = UINT32_MAX, packed = count_packed_heaps(h);
    REQUIRE(packed != UINT32_MAX);
    for (uint32_t i = h->loose; i != UINT32_MAX && count <= h->end; i = h->heaps[i].next, count++)
        REQUIRE(h->heaps[i].loose);
    for (uint32_t b = 0; b <= h->capacity; b++) {
        REQUIRE((h->buckets[b] != UINT32_MAX) == (h->bits[b / 64] >> b % 64 & 1));
        for (uint32_t i = h->buckets[b]; i != UINT32_MAX; i = h->heaps[i].next, count++) {
            REQUIRE(count <= h->end);
            REQUIRE(!h->heaps[i].loose && h->heaps[i].free_count == b);
        }
    }
    REQUIRE(count + packed == h->live_count);
    for (uint32_t i = 0; i < h->end; i++)
        if (!h->heaps[i].packed && h->heaps[i].free_count > 0 && h->heaps[i].free_count < fewest)
            fewest = h->heaps[i].free_count;
    if (h->open != UINT32_MAX && h->heaps[h->open].free_count > 0)
        REQUIRE(h->heaps[h->open].loose && h->heaps[h->open].free_count == fewest);
    return NULL;
}

/** The GIVEN_UP tiles of a texture are linked, oldest first. */
static const char *check_given_up(const slc_manager *m, const struct slc_managed_texture *t,
                                  uint32_t *tiles)
{
    uint32_t previous = 0;
    for (uint32_t node = t->given_up_first; node;
         node = (uint32_t)slc_node_at(&m->residency, node)->order) {
        const struct slc_node *n = slc_node_at(&m->residency, node);
        REQUIRE(n->state == SLUICE_TILE_STATE_GIVEN_UP && n->owner == t->index);
        REQUIRE((uint32_t)(n->order >> 32) == previous);
        REQUIRE(++*tiles <= m->residency.given_up.count);
        previous = node;
    }
    REQUIRE(t->given_up_last == previous);
    REQUIRE(t->trouble < SLC_TROUBLE_COUNT);
    REQUIRE(t->trouble != SLC_TROUBLE_NONE || t->given_up_first == 0);
    return NULL;
}

/** Every texture in trouble is in the list of its state, in the order of their times. */
static const char *check_troubles(const slc_manager *m)
{
    uint32_t tiles = 0, listed = 0, troubled = 0;
    for (uint32_t i = 0; i < m->texture_end; i++) {
        const struct slc_managed_texture *t = slc_texture_at(m, i);
        troubled += t->live && t->trouble != SLC_TROUBLE_NONE;
        const char *wrong = t->live ? check_given_up(m, t, &tiles) : NULL;
        if (wrong)
            return wrong;
    }
    REQUIRE(tiles == m->residency.given_up.count);
    for (int s = SLC_TROUBLE_RESTING; s < SLC_TROUBLE_COUNT; s++) {
        uint32_t count = 0, previous = SLC_NONE;
        for (uint32_t i = m->troubles[s].first; count < m->troubles[s].count; count++) {
            const struct slc_managed_texture *t = slc_texture_at(m, i);
            REQUIRE(t->live && t->trouble == s && t->trouble_prev == previous);
            previous = i;
            i = t->trouble_next;
        }
        REQUIRE(count == 0 || previous == m->troubles[s].last);
        listed += count;
    }
    REQUIRE(listed == troubled && listed == m->trouble_count);
    return NULL;
}

static const char *check_heaps(const slc_manager *m)
{
    uint64_t free_total = 0;
    uint32_t live = 0;
    for (uint32_t i = 0; i < m->residency.heaps.end; i++) {
        const struct slc_tile_heap *h = &m->residency.heaps.heaps[i];
        if (h->free_count == SLC_HEAP_DEAD)
            continue;
        uint32_t used = 0, retiring = 0;
        for (uint32_t slot = 0; slot < m->residency.heaps.capacity; slot++) {
            uint32_t node = h->nodes[slot];
            if (!node)
                continue;
            REQUIRE(slc_node_at(&m->residency, node)->heap == i &&
                    slc_node_at(&m->residency, node)->slot == slot);
            used++;
            retiring += slc_node_at(&m->residency, node)->state == SLC_NODE_RETIRING;
        }
        REQUIRE(used + h->free_count == m->residency.heaps.capacity);
        REQUIRE(retiring == h->retiring_count);
        free_total += h->free_count;
        live++;
    }
    REQUIRE(free_total == m->residency.heaps.free_total);
    REQUIRE(live == m->residency.heaps.live_count);
    return check_buckets(&m->residency.heaps);
}

/** The nodes without slots are counted by state. */
static const char *check_outside(const slc_manager *m)
{
    uint32_t counts[8] = {0};
    for (uint32_t i = 0; i < m->texture_end; i++) {
        const struct slc_managed_texture *t = slc_texture_at(m, i);
        bool outside = t->live && t->shape->desc.packedTilesOutside;
        for (uint32_t k = 0; outside && k < t->shape->desc.packedTileCount; k++) {
            uint32_t node = slc_find_node(t, t->shape->regular_tile_count + k);
            if (node)
                counts[slc_node_at(&m->residency, node)->state]++;
        }
    }
    for (uint32_t s = 0; s < 8; s++)
        REQUIRE(counts[s] == m->residency.outside_counts[s]);
    return NULL;
}

static const char *check_all_users(const slc_manager *m)
{
    const char *wrong = NULL;
    for (uint32_t i = 0; i < m->texture_end && !wrong; i++)
        if (slc_texture_at(m, i)->live)
            wrong = check_users(m, slc_texture_at(m, i));
    return wrong;
}

const char *slc_manager_check(const SluiceStreamedTextureManager *manager)
{
    const char *wrong = slc_manager_check_restored(manager);
    return wrong ? wrong : check_all_users(manager);
}

const char *slc_manager_check_restored(const SluiceStreamedTextureManager *manager)
{
    const slc_manager *m = manager;
    const char *wrong = check_lists(m);
    if (!wrong)
        wrong = check_heaps(m);
    if (!wrong)
        wrong = check_visited(m);
    if (!wrong)
        wrong = check_troubles(m);
    uint64_t nodes = 0, tiles = 0;
    uint32_t textures = 0;
    for (uint32_t i = 0; i < m->texture_end && !wrong; i++) {
        const struct slc_managed_texture *t = slc_texture_at(m, i);
        if (!t->live)
            continue;
        wrong = check_texture(m, t, &nodes);
        tiles += t->shape->tile_count;
        textures++;
    }
    if (wrong)
        return wrong;
    REQUIRE(textures == m->texture_count && tiles == m->tile_count);
    wrong = check_outside(m);
    if (wrong)
        return wrong;
    uint64_t states = 0;
    for (uint32_t s = 0; s < 8; s++)
        states += m->residency.state_counts[s];
    REQUIRE(states == nodes);
    REQUIRE(nodes + m->residency.retiring.count + m->residency.free_node_count + 1 ==
            m->residency.node_end);
    return NULL;
}
