/* The calls that hand out tiles. */
#include "core/internal.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "core/history.h"
#include "core/wants.h"

#include <stdlib.h>

static bool in_scope(const slc_manager *m, const struct slc_texture *scope, uint32_t node)
{
    return !scope || slc_node_at(m, node)->texture == scope->index;
}

static uint32_t count_in_scope(const slc_manager *m, const struct slc_list *list,
                               const struct slc_texture *scope)
{
    if (!scope)
        return list->count;
    uint32_t count = 0;
    for (uint32_t node = list->head; node; node = slc_node_at(m, node)->next)
        count += in_scope(m, scope, node);
    return count;
}

/* To map ------------------------------------------------------------------------------------ */

uint32_t slc_reserved_slots(const slc_manager *m)
{
    uint64_t slots = (uint64_t)m->heaps.live_count * m->heaps.capacity;
    return slots / 16 < 64 ? (uint32_t)(slots / 16) : 64;
}

/**
 * Slots that a tile of `level` leaves in a call for one texture when no heap is to be had: what
 * makes room for coarser requests of other textures must not go to the texture that is asked first.
 */
static uint64_t owed_slots(const slc_manager *m, uint32_t level)
{
    uint32_t limit = m->config.maxHeapCount;
    uint64_t owed = 0;
    if (!m->refused && (!limit || m->heaps.live_count < limit))
        return 0;
    for (uint32_t l = level + 1; l < SLUICE_MAX_MIP_LEVELS; l++)
        owed += m->requests.counts[l];
    return owed;
}

/** A free slot for the node, from a new heap if need be. The last ones are for packed tiles. */
static SluiceResult take_slot(slc_manager *m, const struct slc_texture *scope, uint32_t node,
                              bool *refused)
{
    struct slc_node *n = slc_node_at(m, node);
    bool packed = n->tile >= slc_texture_at(m, n->texture)->shape->regular_tile_count;
    uint64_t kept = slc_reserved_slots(m) + (scope ? owed_slots(m, n->level) : 0);
    if ((packed || m->heaps.free_total > kept) &&
        slc_tile_heaps_take(&m->heaps, node, &n->heap, &n->slot))
        return SLUICE_SUCCESS;
    uint32_t limit = m->config.maxHeapCount;
    if (*refused || (limit && m->heaps.live_count >= limit))
        return SLUICE_BUDGET_REACHED;
    struct slc_call call = {.kind = SLC_CALL_HEAP_ANSWER};
    SluiceResult result = slc_tile_heaps_add(&m->heaps, &call.result, &call.heap_id);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return result;
    slc_notify(m, &call);
    *refused = m->refused = result != SLUICE_SUCCESS;
    if (*refused)
        return SLUICE_BUDGET_REACHED;
    slc_tile_heaps_take(&m->heaps, node, &n->heap, &n->slot);
    return SLUICE_SUCCESS;
}

static bool is_idle(const slc_manager *m, const struct slc_texture *t)
{
    uint64_t age = m->time - t->map_time, usual = m->map_interval;
    usual = t->interval > usual ? t->interval : usual;
    usual = t->timeout > usual ? t->timeout : usual;
    return age > 0 && age / (t->interval ? 4 : 16) >= usual; /* it may be a slow one's first */
}

struct request_key {
    uint32_t rank; ///< class and need, greater first
    uint32_t node;
    uint64_t order;
};

static int by_request_order(const void *a, const void *b)
{
    const struct request_key *x = a, *y = b;
    if (x->rank != y->rank)
        return x->rank > y->rank ? -1 : 1;
    return x->order < y->order ? -1 : x->order > y->order;
}

static struct request_key key_of(const slc_manager *m, const struct slc_texture *t, uint32_t node)
{
    const struct slc_node *n = slc_node_at(m, node);
    uint32_t class = n->tile >= t->shape->regular_tile_count ? SLC_PACKED_CLASS : n->level;
    return (struct request_key){class << 8 | n->need, node, n->order};
}

/** Fewer requests of all textures than tiles of this one: they stand in order in the queues. */
static uint32_t pick_requests(const slc_manager *m, const struct slc_texture *t,
                              struct request_key *keys)
{
    uint32_t count = 0;
    for (uint32_t node = slc_first_request(m); node && count < t->requested_count;
         node = slc_next_request(m, node))
        if (in_scope(m, t, node))
            keys[count++] = key_of(m, t, node);
    return count;
}

static uint32_t search_requests(const slc_manager *m, const struct slc_texture *t,
                                struct request_key *keys)
{
    uint32_t count = 0;
    for (uint32_t tile = 0; tile < t->shape->tile_count && count < t->requested_count; tile++) {
        uint32_t node = slc_find_node(t, tile);
        if (node && slc_node_at(m, node)->state == SLUICE_TILE_STATE_REQUESTED)
            keys[count++] = key_of(m, t, node);
    }
    qsort(keys, count, sizeof *keys, by_request_order);
    return count;
}

/** The texture's requests in order; the caller frees `requested_count` keys. */
static struct request_key *sort_requests(const slc_manager *m, const struct slc_texture *t)
{
    struct request_key *keys = slc_alloc(&m->cb, t->requested_count, sizeof *keys);
    if (!keys)
        return NULL;
    bool few = m->requests.count < t->shape->tile_count;
    uint32_t count = few ? pick_requests(m, t, keys) : search_requests(m, t, keys);
    (void)count;
    assert(count == t->requested_count);
    return keys;
}

static uint32_t requests_in_scope(const slc_manager *m, const struct slc_texture *scope)
{
    return scope ? scope->requested_count : m->requests.count;
}

/** Requests that may be passed over in one call, so that a call's cost has a bound. */
enum { MAX_PASSED_OVER = 4096 };

/** Where the next request comes from: a texture's sorted keys, or the queues of all. */
struct request_walk {
    const struct request_key *keys;
    uint32_t at, count; ///< in keys; no keys: all textures
    uint32_t node;      ///< 0: the end
};

static struct request_walk first_request(const slc_manager *m, const struct slc_texture *scope,
                                         const struct request_key *keys)
{
    if (!scope)
        return (struct request_walk){.node = slc_first_request(m)};
    uint32_t count = scope->requested_count;
    return (struct request_walk){keys, 0, count, count ? keys[0].node : 0};
}

/** To be called before the state of the walk's node changes. */
static void next_request(const slc_manager *m, struct request_walk *w)
{
    if (w->count)
        w->node = ++w->at < w->count ? w->keys[w->at].node : 0;
    else
        w->node = slc_next_request(m, w->node);
}

/** Tiles that one call looks at for one that is not seen any more. */
enum { MAX_LOOKED_FOR = 1024 };

/** Where displacing is: each tile is looked at once. */
struct displacing {
    uint32_t looks;
    uint32_t left[SLUICE_MAX_MIP_LEVELS]; ///< of m->mapped
};

static struct displacing begin_displacing(const slc_manager *m)
{
    struct displacing d = {.looks = MAX_LOOKED_FOR};
    for (uint32_t l = 0; l < SLUICE_MAX_MIP_LEVELS; l++)
        d.left[l] = m->mapped[l].count;
    return d;
}

/**
 * A wanted tile of a level below `end` that the last map does not show; 0 if none is found. Tiles
 * that are seen go to the end of their list, so all get their turn.
 */
static uint32_t unseen_mapped(slc_manager *m, struct displacing *d, uint32_t end)
{
    for (uint32_t l = 0; l < end && l < SLUICE_MAX_MIP_LEVELS; l++)
        for (struct slc_list *list = &m->mapped[l]; d->left[l] && d->looks; d->looks--) {
            uint32_t node = list->head;
            d->left[l]--;
            if (!slc_is_seen(m, node))
                return node;
            slc_list_remove(m, list, node);
            slc_list_append(m, list, node);
        }
    return 0;
}

/** The finest wanted tile of a level below `end`, the first in its list; 0 if there is none. */
static uint32_t finest_mapped(const slc_manager *m, uint32_t end)
{
    for (uint32_t l = 0; l < end && l < SLUICE_MAX_MIP_LEVELS; l++)
        if (m->mapped[l].head)
            return m->mapped[l].head;
    return 0;
}

static void displace(slc_manager *m, struct displacing *d, uint32_t node)
{
    uint32_t level = slc_node_at(m, node)->level;
    slc_node_displace(m, node);
    d->left[level] = slc_min_u32(d->left[level], m->mapped[level].count);
}

/** A wanted tile that may make room for the request; 0 if there is none. */
static uint32_t displaceable_for(slc_manager *m, struct displacing *d, uint32_t request)
{
    const struct slc_node *n = slc_node_at(m, request);
    if (n->tile >= slc_texture_at(m, n->texture)->shape->regular_tile_count)
        return finest_mapped(m, SLUICE_MAX_MIP_LEVELS);
    bool waited = n->order < m->round.waited, waited_long = n->order < m->round.waited_long;
    uint32_t node = unseen_mapped(m, d, n->level + waited);
    uint32_t gap = waited_long ? 0 : waited ? 1 : 2;
    return node ? node : n->level > gap ? finest_mapped(m, n->level - gap) : 0;
}

/**
 * Wanted tiles make room for requests that are coarser: what came first would stay sharp else, and
 * what comes later would not be seen. It ends, because each exchange is for something coarser or
 * takes a tile that is not seen. A tile that is seen is not worth the upload for one or two levels
 * unless the request has waited for rounds of maps.
 */
static void displace_for(slc_manager *m, struct request_walk walk, uint32_t unserved)
{
    struct displacing d = begin_displacing(m);
    uint64_t coming = (uint64_t)m->unmapping.count + m->retiring.count;
    uint64_t reserved = slc_reserved_slots(m), free_slots = m->heaps.free_total;
    for (; free_slots + coming < reserved; coming++) {
        uint32_t victim = finest_mapped(m, SLUICE_MAX_MIP_LEVELS);
        if (!victim)
            return;
        displace(m, &d, victim);
    }
    coming -= free_slots < reserved ? reserved - free_slots : 0;
    for (uint32_t passed = 0; walk.node && unserved && passed < MAX_PASSED_OVER; passed++) {
        if (slc_is_asked_for(m, walk.node)) {
            unserved--;
            uint32_t victim = coming ? 0 : displaceable_for(m, &d, walk.node);
            if (!coming && !victim)
                return;
            if (victim)
                displace(m, &d, victim);
            coming -= coming > 0;
        }
        next_request(m, &walk);
    }
}

/**
 * Makes room for `unserved` requests out of what is on standby or not looked at any more. Returns
 * whether a texture was forgotten and requests with it.
 */
static bool list_standby_for(slc_manager *m, uint32_t unserved)
{
    uint64_t needed = unserved, reserved = slc_reserved_slots(m);
    bool forgot = false;
    if (reserved > m->heaps.free_total)
        needed += reserved - m->heaps.free_total;
    while ((uint64_t)m->unmapping.count + m->retiring.count + m->standby.count < needed &&
           m->visit_first != SLC_NONE && is_idle(m, slc_texture_at(m, m->visit_first))) {
        slc_wants_forget(m, slc_texture_at(m, m->visit_first));
        forgot = true;
    }
    uint64_t coming = (uint64_t)m->unmapping.count + m->retiring.count;
    uint64_t take = needed > coming ? needed - coming : 0;
    slc_list_standby(m, m->standby.count > take ? m->standby.count - (uint32_t)take : 0);
    return forgot;
}

/** What will be needed for the requests that come next. */
static void prefetch_request(const slc_manager *m, uint32_t node)
{
    if (!node)
        return;
    const struct slc_node *n = slc_node_at(m, node);
    const struct slc_texture *t = slc_texture_at(m, n->texture);
    __builtin_prefetch(t);
    __builtin_prefetch(&t->shape->levels[n->level]);
    __builtin_prefetch(slc_node_at(m, n->next));
}

/** Textures that one call looks at for something to prefetch. */
enum { MAX_LOOKED_AT = 256 };

static bool may_prefetch(const slc_manager *m)
{
    uint32_t kept = m->standby.count + m->state_counts[SLUICE_TILE_STATE_CANCELLED];
    return kept < m->config.numExtraStandbyTiles && m->heaps.free_total > slc_reserved_slots(m);
}

/**
 * Hands out FREE tiles of a level. Anything but SUCCESS ends prefetching: BUDGET_REACHED where no
 * more may be, INCOMPLETE where the list is full.
 */
static SluiceResult prefetch_level(slc_manager *m, struct slc_texture *t, uint32_t level,
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
        if (!slc_reserve_nodes(m, 1) || slc_state_make(m, t) != SLUICE_SUCCESS) {
            slc_state_release(m, t); /* half made */
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        }
        uint32_t node = slc_node_prefetch(m, t, tile, level);
        struct slc_node *n = slc_node_at(m, node);
        slc_tile_heaps_take(&m->heaps, node, &n->heap, &n->slot);
        tiles[(*written)++] = slc_node_tile(m, node);
    }
    return SLUICE_SUCCESS;
}

/**
 * Nothing is requested: loads the coarse levels of what may come into view. INCOMPLETE if the list
 * is full or host memory runs out, but that is the error if nothing was handed out.
 */
static SluiceResult prefetch(slc_manager *m, uint32_t room, uint32_t *written, SluiceTile *tiles)
{
    uint32_t level_before = m->prefetch_level, texture_before = m->prefetch_texture;
    for (uint32_t i = 0; i < MAX_LOOKED_AT && i < m->texture_end; i++) {
        if (m->prefetch_texture >= m->texture_end) {
            m->prefetch_texture = 0;
            m->prefetch_level++;
        }
        if (m->prefetch_level >= m->config.prefetchLevels)
            m->prefetch_level = 0;
        struct slc_texture *t = slc_texture_at(m, m->prefetch_texture);
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

/** Rounds of maps. */
enum { LONG_WAIT = 4 };

/** A round is over when as many maps have come as there are textures that hold something. */
static void end_round(slc_manager *m)
{
    if (m->round.maps < slc_max_u32(m->visited_count, 1))
        return;
    m->round.maps = 0;
    m->round.waited = m->round.began;
    m->round.began = m->requests.next_sequence;
    if (++m->round.count % LONG_WAIT == 0) {
        m->round.waited_long = m->round.began_long;
        m->round.began_long = m->round.began;
    }
}

static SluiceResult hand_out(slc_manager *m, const struct slc_texture *scope,
                             const struct request_key *keys, uint32_t *count, SluiceTile *tiles)
{
    uint32_t room = *count, written = 0, passed_over = 0;
    uint64_t limit = slc_slot_limit(m);
    bool refused = false;
    SluiceResult result = SLUICE_SUCCESS;
    struct request_walk walk = first_request(m, scope, keys);
    while (written < room && walk.node && passed_over < MAX_PASSED_OVER) {
        uint32_t node = walk.node;
        if (m->starved && !slc_is_asked_for(m, node)) {
            next_request(m, &walk);
            passed_over++;
            continue;
        }
        result = take_slot(m, scope, node, &refused);
        if (result != SLUICE_SUCCESS)
            break;
        next_request(m, &walk);
        prefetch_request(m, walk.node);
        slc_tile_handed_out(m, node);
        tiles[written++] = slc_node_tile(m, node);
    }
    if (!scope && m->requests.count == 0 && m->config.prefetchLevels && result == SLUICE_SUCCESS)
        result = prefetch(m, room, &written, tiles);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY && written == 0)
        return result;
    end_round(m);
    slc_update_bias(m, limit); /* not earlier: a call that fails changes nothing */
    m->handed_out_total += written;
    *count = written;
    uint32_t left = requests_in_scope(m, scope);
    if (room > 0)
        m->starved = result == SLUICE_BUDGET_REACHED;
    if (result == SLUICE_BUDGET_REACHED) {
        if (!list_standby_for(m, slc_min_u32(left, room - written)))
            displace_for(m, walk, slc_min_u32(left, room - written));
    }
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY) {
        result = SLUICE_SUCCESS; /* what was handed out stands; the next call meets it first */
        m->cut_short = true;
    }
    return result == SLUICE_SUCCESS && left > 0 ? SLUICE_INCOMPLETE : result;
}

static SluiceResult get_tiles_to_map(slc_manager *m, SluiceTextureId id, uint32_t *count,
                                     SluiceTile *tiles)
{
    struct slc_texture *scope;
    SluiceResult result = slc_find_scope(m, id, &scope);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t requests = requests_in_scope(m, scope);
    if (!tiles) {
        *count = requests;
        return SLUICE_SUCCESS;
    }
    if (!scope || requests == 0)
        return hand_out(m, scope, NULL, count, tiles);
    struct request_key *keys = sort_requests(m, scope);
    if (!keys)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    result = hand_out(m, scope, keys, count, tiles);
    slc_free(&m->cb, keys, requests, sizeof *keys);
    return result;
}

/* The other lists --------------------------------------------------------------------------- */

/** False if there is no host memory for it; then nothing has happened. */
typedef bool (*take_function)(slc_manager *m, uint32_t node, uint64_t retire_value);

/** Hands out a list from its head, as far as it is in scope. */
static SluiceResult take_list(slc_manager *m, struct slc_list *list,
                              const struct slc_texture *scope, uint64_t retire_value,
                              take_function take, uint32_t *count, SluiceTile *tiles)
{
    if (!tiles) {
        *count = count_in_scope(m, list, scope);
        return SLUICE_SUCCESS;
    }
    uint32_t room = *count, written = 0;
    uint32_t node = list->head;
    while (node) {
        uint32_t next = slc_node_at(m, node)->next;
        if (in_scope(m, scope, node)) {
            if (written == room)
                break;
            tiles[written] = slc_node_tile(m, node);
            if (!take(m, node, retire_value)) {
                m->cut_short = true;
                break;
            }
            written++;
        }
        node = next;
    }
    if (m->cut_short && written == 0)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *count = written;
    return node ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

static bool take_unmapped(slc_manager *m, uint32_t node, uint64_t retire_value)
{
    struct slc_texture *t = slc_texture_at(m, slc_node_at(m, node)->texture);
    if (!(slc_node_at(m, node)->flags & SLC_NODE_WANTED))
        slc_node_retire(m, node, retire_value);
    else if (!slc_node_unmap_displaced(m, node, retire_value))
        return false;
    slc_state_release(m, t);
    m->unmapped_total++;
    return true;
}

static bool take_cancelled(slc_manager *m, uint32_t node, uint64_t retire_value)
{
    (void)retire_value;
    slc_list_remove(m, &m->cancelled, node);
    slc_node_at(m, node)->flags |= SLC_NODE_LISTED;
    return true;
}

static SluiceResult get_tiles_to_unmap(slc_manager *m, SluiceTextureId id, uint64_t retire_value,
                                       uint32_t *count, SluiceTile *tiles)
{
    struct slc_texture *scope;
    SluiceResult result = slc_find_scope(m, id, &scope);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_retire_is_backwards(m, retire_value))
        return SLUICE_ERROR_TIME_BACKWARDS;
    result = take_list(m, &m->unmapping, scope, retire_value, take_unmapped, count, tiles);
    if (tiles && retire_value && result >= SLUICE_SUCCESS)
        m->last_retire = retire_value;
    return result;
}

static SluiceResult get_tiles_to_cancel(slc_manager *m, SluiceTextureId id, uint32_t *count,
                                        SluiceTile *tiles)
{
    struct slc_texture *scope;
    SluiceResult result = slc_find_scope(m, id, &scope);
    if (result != SLUICE_SUCCESS)
        return result;
    return take_list(m, &m->cancelled, scope, 0, take_cancelled, count, tiles);
}

static SluiceResult get_given_up_tiles(slc_manager *m, uint32_t *count, SluiceTile *tiles)
{
    uint32_t waiting = m->report_end - m->report_first;
    if (!tiles) {
        *count = waiting;
        return SLUICE_SUCCESS;
    }
    uint32_t written = slc_min_u32(*count, waiting);
    for (uint32_t i = 0; i < written; i++) {
        struct slc_given_up g = m->given_up_reports[m->report_first + i];
        struct slc_place p = slc_tile_place(slc_texture_at(m, (uint32_t)g.texture_id), g.tile);
        tiles[i] = (SluiceTile){g.texture_id, g.tile, p.level, p.x, p.y, 0, 0};
        slc_map_remove(&m->reported, slc_pair_key((uint32_t)g.texture_id, g.tile));
    }
    m->report_first += written;
    if (m->report_first == m->report_end)
        m->report_first = m->report_end = 0;
    *count = written;
    return written < waiting ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

/* Entry points ------------------------------------------------------------------------------ */

SluiceResult sluiceGetTilesToMap(SluiceStreamedTextureManager *manager, SluiceTextureId textureId,
                                 uint32_t *pTileCount, SluiceTile *pTiles)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_GET_TILES_TO_MAP,
                            .texture_id = textureId,
                            .query = !pTiles,
                            .tiles = pTiles};
    if (!pTileCount) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        call.room = *pTileCount;
        manager->cut_short = false;
        call.result = get_tiles_to_map(manager, textureId, pTileCount, pTiles);
        call.count = *pTileCount;
        if (manager->cut_short)
            call.room = call.count; /* which gives the same where memory suffices */
    }
    slc_notify(manager, &call);
    return call.result;
}

SluiceResult sluiceGetTilesToUnmap(SluiceStreamedTextureManager *manager, SluiceTextureId textureId,
                                   uint64_t retireValue, uint32_t *pTileCount, SluiceTile *pTiles)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_GET_TILES_TO_UNMAP,
                            .texture_id = textureId,
                            .retire_value = retireValue,
                            .query = !pTiles,
                            .tiles = pTiles};
    if (!pTileCount) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        call.room = *pTileCount;
        manager->cut_short = false;
        call.result = get_tiles_to_unmap(manager, textureId, retireValue, pTileCount, pTiles);
        call.count = *pTileCount;
        if (manager->cut_short)
            call.room = call.count;
    }
    slc_notify(manager, &call);
    return call.result;
}

SluiceResult sluiceGetTilesToCancel(SluiceStreamedTextureManager *manager,
                                    SluiceTextureId textureId, uint32_t *pTileCount,
                                    SluiceTile *pTiles)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_GET_TILES_TO_CANCEL,
                            .texture_id = textureId,
                            .query = !pTiles,
                            .tiles = pTiles};
    if (!pTileCount) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        call.room = *pTileCount;
        manager->cut_short = false;
        call.result = get_tiles_to_cancel(manager, textureId, pTileCount, pTiles);
        call.count = *pTileCount;
    }
    slc_notify(manager, &call);
    return call.result;
}

SluiceResult sluiceGetGivenUpTiles(SluiceStreamedTextureManager *manager, uint32_t *pTileCount,
                                   SluiceTile *pTiles)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_GET_GIVEN_UP, .query = !pTiles, .tiles = pTiles};
    if (!pTileCount) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        call.room = *pTileCount;
        call.result = get_given_up_tiles(manager, pTileCount, pTiles);
        call.count = *pTileCount;
    }
    slc_notify(manager, &call);
    return call.result;
}

SluiceResult sluiceTrimStandbyTiles(SluiceStreamedTextureManager *manager, uint32_t keepTileCount)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    slc_list_standby(manager, keepTileCount);
    struct slc_call call = {.kind = SLC_CALL_TRIM_STANDBY, .keep_count = keepTileCount};
    slc_notify(manager, &call);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceCompleteRetireValue(SluiceStreamedTextureManager *manager, uint64_t retireValue)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {.kind = SLC_CALL_COMPLETE_RETIRE, .retire_value = retireValue};
    if (retireValue < manager->completed_retire && retireValue != 0) {
        call.result = SLUICE_ERROR_TIME_BACKWARDS;
    } else if (retireValue != 0) {
        manager->completed_retire = retireValue;
        slc_collect_retired(manager);
    }
    slc_notify(manager, &call);
    return call.result;
}

/* Heaps ------------------------------------------------------------------------------------- */

SluiceResult sluiceGetEmptyHeaps(const SluiceStreamedTextureManager *manager, uint32_t *pHeapCount,
                                 uint32_t *pHeapIds)
{
    if (!manager || !pHeapCount)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_tile_heaps *h = &manager->heaps;
    uint32_t room = *pHeapCount, found = 0;
    uint64_t rest = h->free_total, keep = h->capacity / 2 + slc_reserved_slots(manager);
    if (rest == (uint64_t)h->live_count * h->capacity)
        keep = 0; /* no tile is left */
    for (uint32_t i = 0; i < h->end; i++) {
        if (h->heaps[i].free_count != h->capacity || rest - h->capacity < keep)
            continue;
        rest -= h->capacity;
        if (pHeapIds && found < room)
            pHeapIds[found] = h->heaps[i].id;
        found++;
    }
    *pHeapCount = pHeapIds ? slc_min_u32(found, room) : found;
    return pHeapIds && found > room ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

static SluiceResult release_heap(slc_manager *m, uint32_t heap_id)
{
    uint32_t heap = slc_tile_heaps_find(&m->heaps, heap_id);
    if (heap == UINT32_MAX)
        return SLUICE_ERROR_UNKNOWN_HEAP;
    if (m->heaps.heaps[heap].free_count != m->heaps.capacity)
        return SLUICE_ERROR_HEAP_IN_USE;
    slc_tile_heaps_release(&m->heaps, heap);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceReleaseHeap(SluiceStreamedTextureManager *manager, uint32_t heapId)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {
        .kind = SLC_CALL_RELEASE_HEAP, .heap_id = heapId, .result = release_heap(manager, heapId)};
    slc_notify(manager, &call);
    return call.result;
}
