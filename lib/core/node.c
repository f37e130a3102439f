#include "core/internal.h"

#include "base/alloc.h"

/* Lists ------------------------------------------------------------------------------------- */

void slc_list_append(slc_manager *m, struct slc_list *list, uint32_t node)
{
    slc_node_at(m, node)->prev = list->tail;
    slc_node_at(m, node)->next = 0;
    if (list->tail)
        slc_node_at(m, list->tail)->next = node;
    else
        list->head = node;
    list->tail = node;
    list->count++;
}

void slc_list_remove(slc_manager *m, struct slc_list *list, uint32_t node)
{
    const struct slc_node *n = slc_node_at(m, node);
    if (n->prev)
        slc_node_at(m, n->prev)->next = n->next;
    else
        list->head = n->next;
    if (n->next)
        slc_node_at(m, n->next)->prev = n->prev;
    else
        list->tail = n->prev;
    list->count--;
}

/** Behind the last node that is not due later. */
static void insert_by_due(slc_manager *m, struct slc_list *list, uint32_t node)
{
    uint32_t after = list->tail;
    while (after && (int64_t)(slc_node_at(m, after)->order - slc_node_at(m, node)->order) > 0)
        after = slc_node_at(m, after)->prev;
    if (after == list->tail) {
        slc_list_append(m, list, node);
        return;
    }
    uint32_t before = after ? slc_node_at(m, after)->next : list->head;
    slc_node_at(m, node)->prev = after;
    slc_node_at(m, node)->next = before;
    slc_node_at(m, before)->prev = node;
    if (after)
        slc_node_at(m, after)->next = node;
    else
        list->head = node;
    list->count++;
}

static uint32_t request_class(const slc_manager *m, const struct slc_node *n)
{
    bool packed = n->tile >= slc_texture_at(m, n->texture)->shape->regular_tile_count;
    return packed ? SLC_PACKED_CLASS : n->level;
}

static void request_append(slc_manager *m, uint32_t node)
{
    struct slc_requests *r = &m->requests;
    struct slc_node *n = slc_node_at(m, node);
    struct slc_texture *t = slc_texture_at(m, n->texture);
    uint32_t class = n->tile >= t->shape->regular_tile_count ? SLC_PACKED_CLASS : n->level;
    n->order = r->next_sequence++;
    slc_list_append(m, &r->lists[class][n->need], node);
    r->needs[class] |= 1u << n->need;
    r->classes |= 1u << class;
    r->count++;
    r->counts[class]++;
    t->requested_count++;
}

static void request_remove(slc_manager *m, uint32_t node)
{
    struct slc_requests *r = &m->requests;
    struct slc_node *n = slc_node_at(m, node);
    struct slc_texture *t = slc_texture_at(m, n->texture);
    uint32_t class = n->tile >= t->shape->regular_tile_count ? SLC_PACKED_CLASS : n->level;
    struct slc_list *list = &r->lists[class][n->need];
    slc_list_remove(m, list, node);
    if (list->count == 0)
        r->needs[class] &= ~(1u << n->need);
    if (r->needs[class] == 0)
        r->classes &= ~(1u << class);
    r->count--;
    r->counts[class]--;
    t->requested_count--;
}

static uint32_t last_bit(uint32_t bits)
{
    return 31u - (uint32_t)__builtin_clz(bits);
}

static uint32_t first_of(const struct slc_requests *r, uint32_t classes)
{
    if (!classes)
        return 0;
    uint32_t class = last_bit(classes);
    return r->lists[class][last_bit(r->needs[class])].head;
}

uint32_t slc_first_request(const slc_manager *m)
{
    return first_of(&m->requests, m->requests.classes);
}

uint32_t slc_next_request(const slc_manager *m, uint32_t node)
{
    const struct slc_requests *r = &m->requests;
    const struct slc_node *n = slc_node_at(m, node);
    if (n->next)
        return n->next;
    uint32_t class = request_class(m, n), needs = r->needs[class] & ((1u << n->need) - 1);
    if (needs)
        return r->lists[class][last_bit(needs)].head;
    return first_of(r, r->classes & ((1u << class) - 1));
}

static bool is_regular(const slc_manager *m, const struct slc_node *n)
{
    return n->tile < slc_texture_at(m, n->texture)->shape->regular_tile_count;
}

/** Takes the node out of the list that its state keeps it in, if any. */
static void leave_list(slc_manager *m, uint32_t node)
{
    struct slc_node *n = slc_node_at(m, node);
    switch ((SluiceTileState)n->state) {
    case SLUICE_TILE_STATE_FREE:
    case SLUICE_TILE_STATE_ALLOCATED: break;
    case SLUICE_TILE_STATE_MAPPED:
        if (is_regular(m, n))
            slc_list_remove(m, &m->mapped[n->level], node);
        break;
    case SLUICE_TILE_STATE_REQUESTED: request_remove(m, node); break;
    case SLUICE_TILE_STATE_STANDBY:
        m->displaced -= (n->flags & SLC_NODE_WANTED) != 0;
        slc_list_remove(m, n->flags & SLC_NODE_LISTED ? &m->unmapping : &m->standby, node);
        break;
    case SLUICE_TILE_STATE_CANCELLED:
        if (!(n->flags & SLC_NODE_LISTED))
            slc_list_remove(m, &m->cancelled, node);
        break;
    case SLUICE_TILE_STATE_FAILED: slc_list_remove(m, &m->failed, node); break;
    case SLUICE_TILE_STATE_GIVEN_UP: slc_list_remove(m, &m->given_up, node); break;
    }
    n->flags = 0;
}

static void enter_list(slc_manager *m, uint32_t node)
{
    const struct slc_node *n = slc_node_at(m, node);
    switch ((SluiceTileState)n->state) {
    case SLUICE_TILE_STATE_FREE:
    case SLUICE_TILE_STATE_ALLOCATED: break;
    case SLUICE_TILE_STATE_MAPPED:
        if (is_regular(m, n))
            slc_list_append(m, &m->mapped[n->level], node);
        break;
    case SLUICE_TILE_STATE_REQUESTED: request_append(m, node); break;
    case SLUICE_TILE_STATE_STANDBY: slc_list_append(m, &m->standby, node); break;
    case SLUICE_TILE_STATE_CANCELLED: slc_list_append(m, &m->cancelled, node); break;
    case SLUICE_TILE_STATE_FAILED: insert_by_due(m, &m->failed, node); break;
    case SLUICE_TILE_STATE_GIVEN_UP: slc_list_append(m, &m->given_up, node); break;
    }
}

/* Nodes ------------------------------------------------------------------------------------- */

static bool add_node_chunk(slc_manager *m)
{
    if (m->node_chunk_count == SLC_RESIDENT / SLC_NODES_PER_CHUNK)
        return false;
    if (m->node_chunk_count == m->node_chunk_room) {
        uint32_t room = m->node_chunk_room ? m->node_chunk_room * 2 : 16;
        struct slc_node **chunks =
            slc_regrow(&m->cb, m->node_chunks, m->node_chunk_room, room, sizeof *chunks);
        if (!chunks)
            return false;
        m->node_chunks = chunks;
        m->node_chunk_room = room;
    }
    struct slc_node *chunk = slc_alloc(&m->cb, SLC_NODES_PER_CHUNK, sizeof *chunk);
    if (!chunk)
        return false;
    m->node_chunks[m->node_chunk_count++] = chunk;
    return true;
}

bool slc_reserve_nodes(slc_manager *m, uint64_t count)
{
    uint32_t before = m->node_chunk_count;
    while (count > (uint64_t)m->free_node_count +
                       (m->node_chunk_count * SLC_NODES_PER_CHUNK - m->node_end)) {
        if (add_node_chunk(m))
            continue;
        /* what was too much once may be so for good */
        while (m->node_chunk_count > before)
            slc_free(&m->cb, m->node_chunks[--m->node_chunk_count], SLC_NODES_PER_CHUNK,
                     sizeof(struct slc_node));
        return false;
    }
    return true;
}

static uint32_t pop_node(slc_manager *m)
{
    uint32_t node = m->free_node;
    if (node) {
        m->free_node = slc_node_at(m, node)->next;
        m->free_node_count--;
        return node;
    }
    assert(m->node_end / SLC_NODES_PER_CHUNK < m->node_chunk_count); /* reserved before */
    return m->node_end++;
}

static uint32_t take_node(slc_manager *m, struct slc_texture *t, uint32_t *cell, uint32_t tile,
                          uint32_t level, SluiceTileState state)
{
    uint32_t node = pop_node(m);
    *slc_node_at(m, node) = (struct slc_node){.texture = t->index,
                                              .tile = tile,
                                              .heap = SLC_NONE,
                                              .level = (uint8_t)level,
                                              .state = (uint8_t)state};
    *cell = node;
    t->regular_nodes += tile < t->shape->regular_tile_count;
    m->state_counts[state]++;
    return node;
}

static void recycle_node(slc_manager *m, uint32_t node)
{
    slc_node_at(m, node)->next = m->free_node;
    slc_node_at(m, node)->texture = SLC_NONE;
    slc_node_at(m, node)->state = SLUICE_TILE_STATE_FREE;
    m->free_node = node;
    m->free_node_count++;
}

/** Ends what ties a node to its tile; list and slot stay as they are. */
static void detach_node(slc_manager *m, uint32_t node)
{
    struct slc_node *n = slc_node_at(m, node);
    struct slc_texture *t = slc_texture_at(m, n->texture);
    *slc_node_cell(t, n->tile) = 0;
    t->regular_nodes -= n->tile < t->shape->regular_tile_count;
}

static bool is_resident(uint8_t state)
{
    return state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
}

void slc_node_set_state(slc_manager *m, uint32_t node, SluiceTileState state)
{
    struct slc_node *n = slc_node_at(m, node);
    uint8_t old = n->state;
    leave_list(m, node);
    m->state_counts[old]--;
    n->state = (uint8_t)state;
    m->state_counts[state]++;
    enter_list(m, node);
    if (is_resident(old) != is_resident(n->state))
        slc_min_mip_changed(m, slc_texture_at(m, n->texture), n, is_resident(n->state));
    if (state == SLUICE_TILE_STATE_STANDBY)
        slc_list_standby(m, m->config.numExtraStandbyTiles);
}

void slc_node_request_again(slc_manager *m, uint32_t node)
{
    leave_list(m, node); /* before the need changes: a REQUESTED one is listed by it */
    m->state_counts[slc_node_at(m, node)->state]--;
    slc_node_at(m, node)->state = SLUICE_TILE_STATE_REQUESTED;
    slc_node_at(m, node)->need = 0;
    m->state_counts[SLUICE_TILE_STATE_REQUESTED]++;
    enter_list(m, node);
}

void slc_node_release(slc_manager *m, uint32_t node)
{
    assert(slc_node_at(m, node)->heap == SLC_NONE);
    slc_node_set_state(m, node, SLUICE_TILE_STATE_FREE);
    m->state_counts[SLUICE_TILE_STATE_FREE]--;
    detach_node(m, node);
    recycle_node(m, node);
}

void slc_node_free_slot(slc_manager *m, uint32_t node)
{
    struct slc_node *n = slc_node_at(m, node);
    if (n->heap != SLC_NONE)
        slc_tile_heaps_give(&m->heaps, n->heap, n->slot);
    n->heap = SLC_NONE;
}

void slc_node_retire(slc_manager *m, uint32_t node, uint64_t retire_value)
{
    if (slc_node_at(m, node)->heap == SLC_NONE || retire_value <= m->completed_retire) {
        slc_node_free_slot(m, node);
        slc_node_release(m, node);
        return;
    }
    slc_node_set_state(m, node, SLUICE_TILE_STATE_FREE);
    m->state_counts[SLUICE_TILE_STATE_FREE]--;
    detach_node(m, node);
    struct slc_node *n = slc_node_at(m, node);
    n->texture = SLC_NONE;
    n->state = SLC_NODE_RETIRING;
    n->order = retire_value;
    m->heaps.heaps[n->heap].retiring_count++;
    slc_list_append(m, &m->retiring, node);
}

void slc_node_retire_slot(slc_manager *m, uint32_t heap, uint32_t slot, uint64_t retire_value)
{
    uint32_t node = pop_node(m);
    *slc_node_at(m, node) = (struct slc_node){.texture = SLC_NONE,
                                              .heap = heap,
                                              .slot = slot,
                                              .state = SLC_NODE_RETIRING,
                                              .order = retire_value};
    m->heaps.heaps[heap].nodes[slot] = node;
    m->heaps.heaps[heap].retiring_count++;
    slc_list_append(m, &m->retiring, node);
}

void slc_collect_retired(slc_manager *m)
{
    /* Values never decrease, so the list is in their order. */
    while (m->retiring.head && slc_node_at(m, m->retiring.head)->order <= m->completed_retire) {
        uint32_t node = m->retiring.head;
        slc_list_remove(m, &m->retiring, node);
        m->heaps.heaps[slc_node_at(m, node)->heap].retiring_count--;
        slc_node_free_slot(m, node);
        recycle_node(m, node);
    }
}

void slc_list_standby(slc_manager *m, uint32_t keep)
{
    while (m->standby.count > keep) {
        uint32_t node = m->standby.head;
        slc_list_remove(m, &m->standby, node);
        slc_node_at(m, node)->flags |= SLC_NODE_LISTED;
        slc_list_append(m, &m->unmapping, node);
    }
}

void slc_node_displace(slc_manager *m, uint32_t node)
{
    struct slc_node *n = slc_node_at(m, node);
    leave_list(m, node);
    m->state_counts[SLUICE_TILE_STATE_MAPPED]--;
    m->state_counts[SLUICE_TILE_STATE_STANDBY]++;
    n->state = SLUICE_TILE_STATE_STANDBY;
    n->flags = SLC_NODE_LISTED | SLC_NODE_WANTED;
    slc_list_append(m, &m->unmapping, node);
    m->displaced++;
}

bool slc_node_unmap_displaced(slc_manager *m, uint32_t node, uint64_t retire_value)
{
    struct slc_node *n = slc_node_at(m, node);
    if (retire_value <= m->completed_retire) {
        slc_node_free_slot(m, node);
    } else {
        if (!slc_reserve_nodes(m, 1))
            return false;
        slc_node_retire_slot(m, n->heap, n->slot, retire_value);
        n->heap = SLC_NONE;
    }
    n->need = 0;
    slc_node_set_state(m, node, SLUICE_TILE_STATE_REQUESTED);
    return true;
}

SluiceTile slc_node_tile(const slc_manager *m, uint32_t node)
{
    const struct slc_node *n = slc_node_at(m, node);
    const struct slc_texture *t = slc_texture_at(m, n->texture);
    struct slc_place place = slc_node_place(t, n);
    bool placed = n->heap != SLC_NONE;
    return (SluiceTile){
        .textureId = slc_texture_id(t),
        .tileIndex = n->tile,
        .mipLevel = place.level,
        .x = place.x,
        .y = place.y,
        .heapId = placed ? m->heaps.heaps[n->heap].id : 0,
        .slot = placed ? n->slot : 0,
    };
}

/* What wants do to a tile ------------------------------------------------------------------- */

/*
 * The moves below are those that a map makes by the thousand, so they do by themselves what
 * slc_node_set_state would do, and not more.
 */

static void count_move(slc_manager *m, struct slc_node *n, SluiceTileState to)
{
    m->state_counts[n->state]--;
    m->state_counts[to]++;
    n->state = (uint8_t)to;
}

static void restore(slc_manager *m, uint32_t node)
{
    struct slc_node *n = slc_node_at(m, node);
    slc_list_remove(m, n->flags & SLC_NODE_LISTED ? &m->unmapping : &m->standby, node);
    n->flags = 0;
    count_move(m, n, SLUICE_TILE_STATE_MAPPED);
    if (is_regular(m, n))
        slc_list_append(m, &m->mapped[n->level], node);
    m->restored_total++;
}

/** A packed tile: regular ones go in runs. */
static void park(slc_manager *m, uint32_t node)
{
    struct slc_node *n = slc_node_at(m, node);
    assert(!is_regular(m, n));
    slc_list_append(m, &m->standby, node);
    count_move(m, n, SLUICE_TILE_STATE_STANDBY);
    if (m->standby.count > m->config.numExtraStandbyTiles)
        slc_list_standby(m, m->config.numExtraStandbyTiles);
}

void slc_tile_handed_out(slc_manager *m, uint32_t node)
{
    request_remove(m, node);
    count_move(m, slc_node_at(m, node), SLUICE_TILE_STATE_ALLOCATED);
}

/* Runs: neighbours in one list that go to the end of another one are moved as a piece. A texture
 * that comes into view or leaves it makes long ones. */

static void splice(slc_manager *m, struct slc_list *from, struct slc_list *to,
                   const struct slc_run *run)
{
    struct slc_node *first = slc_node_at(m, run->first), *last = slc_node_at(m, run->last);
    if (first->prev)
        slc_node_at(m, first->prev)->next = last->next;
    else
        from->head = last->next;
    if (last->next)
        slc_node_at(m, last->next)->prev = first->prev;
    else
        from->tail = first->prev;
    from->count -= run->count;
    first->prev = to->tail;
    last->next = 0;
    if (to->tail)
        slc_node_at(m, to->tail)->next = run->first;
    else
        to->head = run->first;
    to->tail = run->last;
    to->count += run->count;
}

void slc_run_end(slc_manager *m, struct slc_run *run)
{
    struct slc_list *mapped = &m->mapped[run->level];
    uint32_t count = run->count;
    if (count == 0)
        return;
    if (run->wanted) {
        splice(m, &m->standby, mapped, run);
        m->restored_total += count;
    } else {
        splice(m, mapped, &m->standby, run);
    }
    uint32_t *counts = m->state_counts;
    counts[SLUICE_TILE_STATE_MAPPED] += run->wanted ? count : 0 - count;
    counts[SLUICE_TILE_STATE_STANDBY] += run->wanted ? 0 - count : count;
    run->count = 0;
    if (m->standby.count > m->config.numExtraStandbyTiles)
        slc_list_standby(m, m->config.numExtraStandbyTiles);
}

/** Whether it is in the list that runs are taken from. */
static bool fits_run(const struct slc_node *n, bool wanted)
{
    if (wanted)
        return n->state == SLUICE_TILE_STATE_STANDBY && n->flags == 0;
    return n->state == SLUICE_TILE_STATE_MAPPED;
}

bool slc_run_add(slc_manager *m, struct slc_run *run, uint32_t node, uint32_t level, bool wanted)
{
    struct slc_node *n = slc_node_at(m, node);
    if (run->count &&
        !(run->next == node && run->wanted == wanted && run->level == level && fits_run(n, wanted)))
        slc_run_end(m, run); /* which may list this tile for unmapping */
    if (!fits_run(n, wanted))
        return false;
    if (run->count == 0)
        *run = (struct slc_run){.first = node, .level = level, .wanted = wanted};
    run->last = node;
    run->next = n->next;
    run->count++;
    n->state = wanted ? SLUICE_TILE_STATE_MAPPED : SLUICE_TILE_STATE_STANDBY;
    return true;
}

void slc_tile_mapped(slc_manager *m, struct slc_texture *t, uint32_t node)
{
    struct slc_node *n = slc_node_at(m, node);
    n->flags = 0;
    count_move(m, n, SLUICE_TILE_STATE_MAPPED);
    if (n->tile < t->shape->regular_tile_count)
        slc_list_append(m, &m->mapped[n->level], node);
    slc_min_mip_changed(m, t, n, true);
}

void slc_tile_requested(slc_manager *m, struct slc_texture *t, uint32_t *cell, uint32_t tile,
                        uint32_t level, uint32_t need)
{
    uint32_t node = take_node(m, t, cell, tile, level, SLUICE_TILE_STATE_REQUESTED);
    slc_node_at(m, node)->need = (uint8_t)need;
    request_append(m, node);
}

void slc_tile_wanted(slc_manager *m, struct slc_texture *t, uint32_t *cell, uint32_t tile,
                     uint32_t level)
{
    uint32_t node = *cell & ~SLC_RESIDENT;
    if (!node) {
        slc_tile_requested(m, t, cell, tile, level, 0);
        return;
    }
    struct slc_node *n = slc_node_at(m, node);
    if (n->state == SLUICE_TILE_STATE_STANDBY) {
        restore(m, node);
    } else {
        assert(n->state == SLUICE_TILE_STATE_CANCELLED);
        if (n->flags & SLC_NODE_LISTED)
            n->flags |= SLC_NODE_WANTED;
        else
            slc_node_set_state(m, node, SLUICE_TILE_STATE_ALLOCATED);
    }
}

uint32_t slc_node_prefetch(slc_manager *m, struct slc_texture *t, uint32_t tile, uint32_t level)
{
    uint32_t node = take_node(m, t, &t->nodes[tile], tile, level, SLUICE_TILE_STATE_CANCELLED);
    slc_node_at(m, node)->flags = SLC_NODE_LISTED;
    return node;
}

void slc_tile_unwanted(slc_manager *m, uint32_t node)
{
    assert(node);
    switch (slc_node_at(m, node)->state) {
    case SLUICE_TILE_STATE_ALLOCATED:
        slc_node_at(m, node)->failures = 0;
        slc_node_set_state(m, node, SLUICE_TILE_STATE_CANCELLED);
        break;
    case SLUICE_TILE_STATE_MAPPED: park(m, node); break;
    case SLUICE_TILE_STATE_STANDBY:
        slc_node_at(m, node)->flags &= (uint8_t)~SLC_NODE_WANTED;
        m->displaced--;
        break;
    case SLUICE_TILE_STATE_CANCELLED:
        slc_node_at(m, node)->flags &= (uint8_t)~SLC_NODE_WANTED;
        break;
    default: slc_node_release(m, node); break; /* REQUESTED, FAILED, GIVEN_UP */
    }
}

void slc_node_fail(slc_manager *m, uint32_t node, uint64_t time)
{
    struct slc_node *n = slc_node_at(m, node);
    uint32_t limit = m->config.maxLoadAttempts ? m->config.maxLoadAttempts : 5;
    const uint64_t longest = UINT64_C(1) << 62;
    uint64_t delay = m->config.retryDelay < longest ? m->config.retryDelay : longest;
    for (uint32_t i = 0; i < n->failures && delay < longest && delay; i++)
        delay = delay * 2 < longest ? delay * 2 : longest;
    n->failures++;
    if (n->failures >= limit) {
        slc_node_set_state(m, node, SLUICE_TILE_STATE_GIVEN_UP);
        return;
    }
    leave_list(m, node); /* the due time is where the node will stand, so it is set in between */
    m->state_counts[n->state]--;
    n->state = SLUICE_TILE_STATE_FAILED;
    m->state_counts[SLUICE_TILE_STATE_FAILED]++;
    n->order = time + delay;
    enter_list(m, node);
}
