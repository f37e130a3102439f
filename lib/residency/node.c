#include "residency/node.h"

#include "residency/due.h"
#include "residency/node_list.h"
#include "residency/nodes.h"
#include "residency/request_queues.h"
#include "residency/standby.h"

/* Lists ------------------------------------------------------------------------------------- */

/** True if a tile is regular. Wanted packed tiles are never evicted, so no list has them. */
static bool is_regular(const struct slc_node *n)
{
    return !slc_is_packed_class(n->level);
}

static void enter_given_up(struct slc_machine *r, uint32_t node)
{
    slc_list_append(r, &r->given_up, node);
    r->user.given_up(r->user.user, node, true);
}

static void leave_given_up(struct slc_machine *r, uint32_t node)
{
    slc_list_remove(r, &r->given_up, node);
    r->user.given_up(r->user.user, node, false);
}

/** Removes the node from the list of its state, if there is one. */
static void leave_list(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    switch ((SluiceTileState)n->state) {
    case SLUICE_TILE_STATE_FREE:
    case SLUICE_TILE_STATE_ALLOCATED: break;
    case SLUICE_TILE_STATE_MAPPED:
        if (is_regular(n))
            slc_list_remove(r, &r->mapped[n->level], node);
        break;
    case SLUICE_TILE_STATE_REQUESTED: slc_request_remove(r, node); break;
    case SLUICE_TILE_STATE_STANDBY:
        r->evicted_wanted -= (n->flags & SLC_NODE_WANTED) != 0;
        slc_list_remove(r, n->flags & SLC_NODE_LISTED ? &r->evicted : slc_standby_list(r, n), node);
        break;
    case SLUICE_TILE_STATE_CANCELED:
        if (!(n->flags & SLC_NODE_LISTED))
            slc_list_remove(r, &r->canceled, node);
        break;
    case SLUICE_TILE_STATE_FAILED: slc_due_remove(r, node); break;
    case SLUICE_TILE_STATE_GIVEN_UP: leave_given_up(r, node); break;
    }
    n->flags = 0;
}

static void enter_list(struct slc_machine *r, uint32_t node)
{
    const struct slc_node *n = slc_node_at(r, node);
    switch ((SluiceTileState)n->state) {
    case SLUICE_TILE_STATE_FREE:
    case SLUICE_TILE_STATE_ALLOCATED: break;
    case SLUICE_TILE_STATE_MAPPED:
        if (is_regular(n))
            slc_list_append(r, &r->mapped[n->level], node);
        break;
    case SLUICE_TILE_STATE_REQUESTED: slc_request_append(r, node); break;
    case SLUICE_TILE_STATE_STANDBY: slc_list_append(r, slc_standby_list(r, n), node); break;
    case SLUICE_TILE_STATE_CANCELED: slc_list_append(r, &r->canceled, node); break;
    case SLUICE_TILE_STATE_FAILED: slc_due_insert(r, node); break;
    case SLUICE_TILE_STATE_GIVEN_UP: enter_given_up(r, node); break;
    }
}

/** Detaches a node from its tile. List and slot stay. */
static void detach_node(struct slc_machine *r, uint32_t node)
{
    r->user.released(r->user.user, slc_node_at(r, node));
}

/* Nodes ------------------------------------------------------------------------------------- */

static void count_node(struct slc_machine *r, const struct slc_node *n)
{
    r->state_counts[n->state]++;
    r->outside_counts[n->state] += n->level == SLC_OUTSIDE_CLASS;
}

static void uncount_node(struct slc_machine *r, const struct slc_node *n)
{
    r->state_counts[n->state]--;
    r->outside_counts[n->state] -= n->level == SLC_OUTSIDE_CLASS;
}

static void count_move(struct slc_machine *r, struct slc_node *n, SluiceTileState to)
{
    if (r->user.changed)
        r->user.changed(r->user.user, n, n->state, (uint8_t)to);
    uncount_node(r, n);
    n->state = (uint8_t)to;
    count_node(r, n);
}

static uint32_t take_node(struct slc_machine *r, uint32_t owner, uint32_t tile, uint32_t level,
                          SluiceTileState state)
{
    uint32_t node = slc_nodes_take(r);
    *slc_node_at(r, node) = (struct slc_node){.owner = owner,
                                              .tile = tile,
                                              .heap = SLC_NONE,
                                              .level = (uint8_t)level,
                                              .state = (uint8_t)state};
    count_node(r, slc_node_at(r, node));
    if (r->user.changed)
        r->user.changed(r->user.user, slc_node_at(r, node), SLUICE_TILE_STATE_FREE, (uint8_t)state);
    return node;
}

static bool is_resident(uint8_t state)
{
    return state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
}

void slc_node_set_state(struct slc_machine *r, uint32_t node, SluiceTileState state)
{
    struct slc_node *n = slc_node_at(r, node);
    uint8_t old = n->state;
    leave_list(r, node);
    count_move(r, n, state);
    enter_list(r, node);
    if (is_resident(old) != is_resident(n->state))
        r->user.resident(r->user.user, n, is_resident(n->state));
    if (state == SLUICE_TILE_STATE_STANDBY)
        slc_limit_standby(r);
}

void slc_node_request_again(struct slc_machine *r, uint32_t node)
{
    leave_list(r, node); /* before `need` changes, by which REQUESTED nodes are listed */
    count_move(r, slc_node_at(r, node), SLUICE_TILE_STATE_REQUESTED);
    slc_node_at(r, node)->need = 0;
    enter_list(r, node);
}

void slc_node_evict_wanted(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    leave_list(r, node);
    count_move(r, n, SLUICE_TILE_STATE_STANDBY);
    n->flags = SLC_NODE_LISTED | SLC_NODE_WANTED;
    slc_list_append(r, &r->evicted, node);
    r->evicted_wanted++;
}

bool slc_node_unmap_wanted(struct slc_machine *r, uint32_t node, uint64_t retire_value)
{
    struct slc_node *n = slc_node_at(r, node);
    if (n->heap == SLC_NONE || retire_value <= r->completed_retire) {
        slc_node_free_slot(r, node);
    } else {
        if (!slc_reserve_nodes(r, 1))
            return false;
        slc_node_retire_slot(r, n->heap, n->slot, retire_value);
        n->heap = SLC_NONE;
    }
    n->need = 0;
    slc_node_set_state(r, node, SLUICE_TILE_STATE_REQUESTED);
    return true;
}

/* Wanted and unwanted tiles ----------------------------------------------------------------- */

/*
 * A map makes thousands of the following changes. So they do the work of slc_node_set_state
 * themselves, without its general cases.
 */

static void restore(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    slc_list_remove(r, n->flags & SLC_NODE_LISTED ? &r->evicted : slc_standby_list(r, n), node);
    n->flags = 0;
    count_move(r, n, SLUICE_TILE_STATE_MAPPED);
    if (is_regular(n))
        slc_list_append(r, &r->mapped[n->level], node);
    r->restored_total++;
}

/** Makes a packed tile STANDBY. Regular tiles change in runs. */
static void to_standby(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    assert(!is_regular(n));
    slc_list_append(r, slc_standby_list(r, n), node);
    count_move(r, n, SLUICE_TILE_STATE_STANDBY);
    slc_limit_standby(r);
}

void slc_node_handed_out(struct slc_machine *r, uint32_t node)
{
    slc_request_remove(r, node);
    count_move(r, slc_node_at(r, node), SLUICE_TILE_STATE_ALLOCATED);
}

void slc_node_mapped(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    n->flags = 0;
    count_move(r, n, SLUICE_TILE_STATE_MAPPED);
    if (is_regular(n))
        slc_list_append(r, &r->mapped[n->level], node);
    r->user.resident(r->user.user, n, true);
}

uint32_t slc_node_request(struct slc_machine *r, uint32_t owner, uint32_t tile, uint32_t level,
                          uint32_t need)
{
    uint32_t node = take_node(r, owner, tile, level, SLUICE_TILE_STATE_REQUESTED);
    slc_node_at(r, node)->need = (uint8_t)need;
    slc_request_append(r, node);
    return node;
}

void slc_node_wanted(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    if (n->state == SLUICE_TILE_STATE_STANDBY) {
        restore(r, node);
    } else {
        assert(n->state == SLUICE_TILE_STATE_CANCELED);
        if (n->flags & SLC_NODE_LISTED)
            n->flags |= SLC_NODE_WANTED;
        else
            slc_node_set_state(r, node, SLUICE_TILE_STATE_ALLOCATED);
    }
}

uint32_t slc_node_prefetch(struct slc_machine *r, uint32_t owner, uint32_t tile, uint32_t level)
{
    uint32_t node = take_node(r, owner, tile, level, SLUICE_TILE_STATE_CANCELED);
    slc_node_at(r, node)->flags = SLC_NODE_LISTED;
    return node;
}

void slc_node_unwanted(struct slc_machine *r, uint32_t node)
{
    assert(node);
    switch (slc_node_at(r, node)->state) {
    case SLUICE_TILE_STATE_ALLOCATED:
        slc_node_at(r, node)->failures = 0;
        slc_node_set_state(r, node, SLUICE_TILE_STATE_CANCELED);
        break;
    case SLUICE_TILE_STATE_MAPPED: to_standby(r, node); break;
    case SLUICE_TILE_STATE_STANDBY:
        slc_node_at(r, node)->flags &= (uint8_t)~SLC_NODE_WANTED;
        r->evicted_wanted--;
        break;
    case SLUICE_TILE_STATE_CANCELED:
        slc_node_at(r, node)->flags &= (uint8_t)~SLC_NODE_WANTED;
        break;
    default: slc_node_release(r, node); break; /* REQUESTED, FAILED, GIVEN_UP */
    }
}

void slc_node_fail(struct slc_machine *r, uint32_t node, uint64_t time)
{
    struct slc_node *n = slc_node_at(r, node);
    uint32_t limit = r->limits.load_attempts;
    const uint64_t longest = UINT64_C(1) << 62;
    uint64_t delay = r->limits.retry_delay < longest ? r->limits.retry_delay : longest;
    for (uint32_t i = 0; i < n->failures && delay < longest && delay; i++)
        delay = delay * 2 < longest ? delay * 2 : longest;
    n->failures++;
    if (n->failures >= limit) {
        slc_node_set_state(r, node, SLUICE_TILE_STATE_GIVEN_UP);
        return;
    }
    leave_list(r, node); /* before the due time changes, which sorts FAILED nodes */
    count_move(r, n, SLUICE_TILE_STATE_FAILED);
    n->order = time + delay;
    enter_list(r, node);
}

void slc_node_free_slot(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    if (n->heap != SLC_NONE)
        slc_tile_heaps_give(&r->heaps, n->heap, n->slot);
    n->heap = SLC_NONE;
}

void slc_node_retire(struct slc_machine *r, uint32_t node, uint64_t retire_value)
{
    if (slc_node_at(r, node)->heap == SLC_NONE || retire_value <= r->completed_retire) {
        slc_node_free_slot(r, node);
        slc_node_release(r, node);
        return;
    }
    slc_node_set_state(r, node, SLUICE_TILE_STATE_FREE);
    uncount_node(r, slc_node_at(r, node));
    detach_node(r, node);
    struct slc_node *n = slc_node_at(r, node);
    n->owner = SLC_NONE;
    n->state = SLC_NODE_RETIRING;
    n->order = retire_value;
    r->heaps.heaps[n->heap].retiring_count++;
    slc_list_append(r, &r->retiring, node);
}

void slc_node_retire_slot(struct slc_machine *r, uint32_t heap, uint32_t slot,
                          uint64_t retire_value)
{
    uint32_t node = slc_nodes_take(r);
    *slc_node_at(r, node) = (struct slc_node){.owner = SLC_NONE,
                                              .heap = heap,
                                              .slot = slot,
                                              .state = SLC_NODE_RETIRING,
                                              .order = retire_value};
    r->heaps.heaps[heap].nodes[slot] = node;
    r->heaps.heaps[heap].retiring_count++;
    slc_list_append(r, &r->retiring, node);
}

void slc_collect_retired(struct slc_machine *r)
{
    /* Retire values never decrease, so the list is sorted. */
    while (r->retiring.head && slc_node_at(r, r->retiring.head)->order <= r->completed_retire) {
        uint32_t node = r->retiring.head;
        slc_list_remove(r, &r->retiring, node);
        r->heaps.heaps[slc_node_at(r, node)->heap].retiring_count--;
        slc_node_free_slot(r, node);
        slc_nodes_give(r, node);
    }
}

void slc_node_release(struct slc_machine *r, uint32_t node)
{
    assert(slc_node_at(r, node)->heap == SLC_NONE);
    slc_node_set_state(r, node, SLUICE_TILE_STATE_FREE);
    uncount_node(r, slc_node_at(r, node));
    detach_node(r, node);
    slc_nodes_give(r, node);
}

bool slc_node_restore(struct slc_machine *r, const struct slc_node *from, uint32_t *cell)
{
    uint32_t node = slc_nodes_take(r);
    struct slc_node *n = slc_node_at(r, node);
    *n = *from;
    if (n->heap != SLC_NONE && !slc_tile_heaps_restore_slot(&r->heaps, n->heap, n->slot, node))
        return false;
    if (n->state == SLC_NODE_RETIRING) {
        r->heaps.heaps[n->heap].retiring_count++;
        slc_list_append(r, &r->retiring, node);
        return true;
    }
    *cell = node;
    count_node(r, n);
    if (n->state == SLUICE_TILE_STATE_STANDBY && n->flags & SLC_NODE_LISTED)
        slc_list_append(r, &r->evicted, node);
    else if (!(n->flags & SLC_NODE_LISTED))
        enter_list(r, node);
    if (n->state == SLUICE_TILE_STATE_STANDBY)
        r->evicted_wanted += (n->flags & SLC_NODE_WANTED) != 0;
    if (n->state == SLUICE_TILE_STATE_REQUESTED)
        n->order = from->order;
    if (is_resident(n->state))
        r->user.resident(r->user.user, n, true);
    return true;
}
