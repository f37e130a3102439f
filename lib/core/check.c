#include "core/check.h"

#include "core/internal.h"
#include "core/wants.h"

/* Each function answers NULL or the first thing that is wrong. */
#define REQUIRE(condition)                                                                         \
    do {                                                                                           \
        if (!(condition))                                                                          \
            return #condition;                                                                     \
    } while (0)

static bool has_slot(uint8_t state)
{
    return state == SLUICE_TILE_STATE_ALLOCATED || state == SLUICE_TILE_STATE_CANCELLED ||
           state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY ||
           state == SLC_NODE_RETIRING;
}

static const char *check_list(const slc_manager *m, const struct slc_list *list, uint8_t state)
{
    uint32_t count = 0, previous = 0;
    for (uint32_t node = list->head; node; node = slc_node_at(m, node)->next) {
        REQUIRE(slc_node_at(m, node)->prev == previous);
        REQUIRE(slc_node_at(m, node)->state == state);
        REQUIRE(count < m->node_end);
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
        REQUIRE((m->requests.needs[c] != 0) == (m->requests.classes >> c & 1));
        for (uint32_t d = 0; d < SLC_REQUEST_NEEDS; d++) {
            const struct slc_list *list = &m->requests.lists[c][d];
            const char *wrong = check_list(m, list, SLUICE_TILE_STATE_REQUESTED);
            if (wrong)
                return wrong;
            REQUIRE((list->count > 0) == (m->requests.needs[c] >> d & 1));
            count += list->count;
        }
    }
    REQUIRE(count == m->requests.count);
    REQUIRE(count == m->state_counts[SLUICE_TILE_STATE_REQUESTED]);
    return NULL;
}

static const char *check_lists(const slc_manager *m)
{
    const struct {
        const struct slc_list *list;
        uint8_t state;
    } lists[] = {
        {&m->standby, SLUICE_TILE_STATE_STANDBY},     {&m->unmapping, SLUICE_TILE_STATE_STANDBY},
        {&m->cancelled, SLUICE_TILE_STATE_CANCELLED}, {&m->failed, SLUICE_TILE_STATE_FAILED},
        {&m->given_up, SLUICE_TILE_STATE_GIVEN_UP},   {&m->retiring, SLC_NODE_RETIRING},
    };
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        const char *wrong = check_list(m, lists[i].list, lists[i].state);
        if (wrong)
            return wrong;
    }
    uint64_t mapped = 0;
    for (uint32_t l = 0; l < SLUICE_MAX_MIP_LEVELS; l++) {
        const char *wrong = check_list(m, &m->mapped[l], SLUICE_TILE_STATE_MAPPED);
        if (wrong)
            return wrong;
        mapped += m->mapped[l].count;
    }
    REQUIRE(mapped <= m->state_counts[SLUICE_TILE_STATE_MAPPED]); /* packed ones are in none */
    uint32_t displaced = 0;
    for (uint32_t node = m->unmapping.head; node; node = slc_node_at(m, node)->next)
        displaced += (slc_node_at(m, node)->flags & SLC_NODE_WANTED) != 0;
    REQUIRE(displaced == m->displaced);
    REQUIRE(m->standby.count <= m->config.numExtraStandbyTiles);
    REQUIRE(m->standby.count + m->unmapping.count == m->state_counts[SLUICE_TILE_STATE_STANDBY]);
    REQUIRE(m->failed.count == m->state_counts[SLUICE_TILE_STATE_FAILED]);
    REQUIRE(m->given_up.count == m->state_counts[SLUICE_TILE_STATE_GIVEN_UP]);
    return check_requests(m);
}

static uint8_t level_under(const struct slc_texture *t, uint32_t tile)
{
    return t->history ? t->history->under[tile] : SLUICE_MIP_UNTOUCHED;
}

static const char *check_node(const slc_manager *m, const struct slc_texture *t, uint32_t node)
{
    const struct slc_node *n = slc_node_at(m, node);
    REQUIRE(n->texture == t->index);
    REQUIRE(n->tile < t->shape->tile_count);
    REQUIRE(slc_find_node(t, n->tile) == node);
    REQUIRE(n->level == slc_tile_place(t, n->tile).level);
    REQUIRE(n->state != SLUICE_TILE_STATE_FREE && n->state != SLC_NODE_RETIRING);
    REQUIRE(has_slot(n->state) == (n->heap != SLC_NONE));
    if (n->heap != SLC_NONE)
        REQUIRE(m->heaps.heaps[n->heap].nodes[n->slot] == node);
    bool wanted = n->state != SLUICE_TILE_STATE_STANDBY && n->state != SLUICE_TILE_STATE_CANCELLED;
    if (n->flags & SLC_NODE_WANTED)
        wanted = true;
    if (n->tile < t->shape->regular_tile_count)
        REQUIRE(wanted == (level_under(t, n->tile) <= n->level));
    else
        REQUIRE(wanted == (m->info.alwaysMapPackedTiles || t->held_regions > 0));
    return NULL;
}

static bool is_resident(const struct slc_texture *t, struct slc_place p)
{
    return t->nodes[slc_tile_index(t, p)] & SLC_RESIDENT;
}

/** Whether a coarser tile over a regular one, or a packed one, is not resident. */
static bool is_hidden(const struct slc_texture *t, uint32_t tile)
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

static const char *check_resident(const struct slc_texture *t)
{
    uint32_t resident = 0, hidden = 0;
    for (uint32_t i = 0; t->nodes && i < t->shape->regular_tile_count; i++) {
        if (!(t->nodes[i] & SLC_RESIDENT))
            continue;
        resident++;
        hidden += is_hidden(t, i);
    }
    REQUIRE(resident == t->resident_tiles && hidden == t->hidden_tiles);
    return NULL;
}

static const char *check_texture(const slc_manager *m, const struct slc_texture *t, uint64_t *nodes)
{
    uint32_t requested = 0, resident_packed = 0, count = 0;
    for (uint32_t tile = 0; tile < t->shape->tile_count; tile++) {
        uint32_t node = slc_find_node(t, tile);
        if (!node)
            continue;
        const char *wrong = check_node(m, t, node);
        if (wrong)
            return wrong;
        uint8_t state = slc_node_at(m, node)->state;
        requested += state == SLUICE_TILE_STATE_REQUESTED;
        if (slc_node_at(m, node)->tile >= t->shape->regular_tile_count)
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

/** Who shares a history got the same maps; `t` is one of its users. */
static const char *check_users(const slc_manager *m, const struct slc_texture *t)
{
    uint32_t users = 0;
    if (!t->history)
        return NULL;
    for (uint32_t i = 0; i < m->texture_end; i++) {
        const struct slc_texture *other = slc_texture_at(m, i);
        if (!other->live || other->history != t->history)
            continue;
        users++;
        REQUIRE(slc_have_same_shape(t, other));
        REQUIRE(t->held_regions == other->held_regions);
        REQUIRE(t->hits == other->hits && t->returns == other->returns);
    }
    REQUIRE(users == t->history->users);
    REQUIRE(users == 1 || t->history->bias == 0); /* it is dithered by the texture */
    return NULL;
}

static const char *check_visited(const slc_manager *m)
{
    uint32_t count = 0, previous = SLC_NONE;
    for (uint32_t i = m->visit_first; i != SLC_NONE; i = slc_texture_at(m, i)->visit_next) {
        const struct slc_texture *t = slc_texture_at(m, i);
        REQUIRE(t->live && t->visited && t->visit_prev == previous);
        REQUIRE(count < m->texture_count);
        previous = i;
        count++;
    }
    REQUIRE(previous == m->visit_last && count == m->visited_count);
    return NULL;
}

/** Every living heap is in the bucket of its free slots, or loose; none has fewer than the open
 * one. */
static const char *check_buckets(const struct slc_tile_heaps *h)
{
    uint32_t count = 0, fewest = UINT32_MAX;
    for (uint32_t i = h->loose; i != UINT32_MAX && count <= h->end; i = h->heaps[i].next, count++)
        REQUIRE(h->heaps[i].loose);
    for (uint32_t b = 0; b <= h->capacity; b++) {
        REQUIRE((h->buckets[b] != UINT32_MAX) == (h->bits[b / 64] >> b % 64 & 1));
        for (uint32_t i = h->buckets[b]; i != UINT32_MAX; i = h->heaps[i].next, count++) {
            REQUIRE(count <= h->end);
            REQUIRE(!h->heaps[i].loose && h->heaps[i].free_count == b);
        }
    }
    REQUIRE(count == h->live_count);
    for (uint32_t i = 0; i < h->end; i++)
        if (h->heaps[i].free_count > 0 && h->heaps[i].free_count < fewest)
            fewest = h->heaps[i].free_count;
    if (h->open != UINT32_MAX && h->heaps[h->open].free_count > 0)
        REQUIRE(h->heaps[h->open].loose && h->heaps[h->open].free_count == fewest);
    return NULL;
}

static const char *check_heaps(const slc_manager *m)
{
    uint64_t free_total = 0;
    uint32_t live = 0;
    for (uint32_t i = 0; i < m->heaps.end; i++) {
        const struct slc_tile_heap *h = &m->heaps.heaps[i];
        if (h->free_count == SLC_HEAP_DEAD)
            continue;
        uint32_t used = 0, retiring = 0;
        for (uint32_t slot = 0; slot < m->heaps.capacity; slot++) {
            uint32_t node = h->nodes[slot];
            if (!node)
                continue;
            REQUIRE(slc_node_at(m, node)->heap == i && slc_node_at(m, node)->slot == slot);
            used++;
            retiring += slc_node_at(m, node)->state == SLC_NODE_RETIRING;
        }
        REQUIRE(used + h->free_count == m->heaps.capacity);
        REQUIRE(retiring == h->retiring_count);
        free_total += h->free_count;
        live++;
    }
    REQUIRE(free_total == m->heaps.free_total);
    REQUIRE(live == m->heaps.live_count);
    return check_buckets(&m->heaps);
}

const char *slc_manager_check(const SluiceStreamedTextureManager *manager)
{
    const slc_manager *m = manager;
    const char *wrong = check_lists(m);
    if (!wrong)
        wrong = check_heaps(m);
    if (!wrong)
        wrong = check_visited(m);
    uint64_t nodes = 0, tiles = 0;
    uint32_t textures = 0;
    for (uint32_t i = 0; i < m->texture_end && !wrong; i++) {
        const struct slc_texture *t = slc_texture_at(m, i);
        if (!t->live)
            continue;
        wrong = check_texture(m, t, &nodes);
        if (!wrong)
            wrong = check_users(m, t);
        tiles += t->shape->tile_count;
        textures++;
    }
    if (wrong)
        return wrong;
    REQUIRE(textures == m->texture_count && tiles == m->tile_count);
    uint64_t states = 0;
    for (uint32_t s = 0; s < 8; s++)
        states += m->state_counts[s];
    REQUIRE(states == nodes);
    REQUIRE(nodes + m->retiring.count + m->free_node_count + 1 == m->node_end);
    return NULL;
}
