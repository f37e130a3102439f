/*
 * Nodes keep their indices, because forgetting ranges of pages visits them in that order. Free
 * indices keep the order of their list, in which they are used again.
 */
#include "demand/page_snapshot.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "demand/page_lru.h"

/* Limit of page counts, so that products in the bias do not overflow. */
#define MOST_BIAS_PAGES (UINT32_C(1) << 31)
#define MOST_FAILED_TRIALS 6u
#define MOST_NODES (1u << 29)

/* Nodes ------------------------------------------------------------------------------------- */

static void exchange_fields(struct slc_demand_residency *r, struct slc_snapshot_io *io,
                            struct slc_page_node *n)
{
    slc_snapshot_u8(io, &n->state, SLC_PAGE_REFUSED);
    slc_snapshot_u8(io, &n->class_index, (uint8_t)(r->class_count - 1));
    slc_snapshot_u8(io, &n->rank, UINT8_MAX);
    slc_snapshot_u8(io, &n->shown, SLC_SHOW_REFUSED);
    slc_snapshot_u32(io, &n->place, UINT32_MAX);
    slc_snapshot_u64(io, &n->value);
    slc_snapshot_u64(io, &n->shown_value);
    slc_snapshot_u64(io, &n->last_use);
    slc_snapshot_u64(io, &n->touched);
    slc_snapshot_u64(io, &n->visible_from);
    slc_snapshot_flag(io, &n->pinned);
    slc_snapshot_flag(io, &n->dropped);
    if (n->state != SLC_PAGE_LOADING && n->state != SLC_PAGE_RESIDENT)
        return;
    slc_snapshot_u32(io, &n->lru, UINT32_MAX);
    if (io->reading && slc_snapshot_is_good(io) &&
        (n->lru >= r->lru_count || r->lrus[n->lru].class_index != n->class_index))
        slc_snapshot_fail(io, "the snapshot has a page whose kind it lacks");
}

/** Adds a restored page to the counters. */
static void count_page(struct slc_demand_residency *r, const struct slc_page_node *n)
{
    struct slc_page_class *c = &r->classes[n->class_index];
    bool loading = n->state == SLC_PAGE_LOADING, resident = n->state == SLC_PAGE_RESIDENT;
    c->counts.loading += loading;
    c->counts.resident += resident;
    c->counts.refused += n->state == SLC_PAGE_REFUSED;
    c->held += loading || resident;
    c->pinned += n->pinned;
    r->valued += !c->has_memory && (loading || resident);
}

static void exchange_node(struct slc_demand_residency *r, struct slc_snapshot_io *io,
                          uint32_t index)
{
    struct slc_page_nodes *nodes = &r->nodes;
    bool live = !io->reading && slc_page_nodes_find(nodes, nodes->at[index].page) == index;
    uint32_t page = live ? nodes->at[index].page : 0;
    slc_snapshot_flag(io, &live);
    if (live)
        slc_snapshot_u32(io, &page, UINT32_MAX);
    if (io->reading && slc_snapshot_is_good(io)) {
        if (!slc_page_nodes_reserve(nodes, &r->cb))
            io->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        else if (!live)
            slc_page_nodes_restore_free(nodes);
        else if (slc_page_nodes_find(nodes, page) != SLC_NO_NODE)
            slc_snapshot_fail(io, "the snapshot has a page twice");
        else
            slc_page_nodes_add(nodes, page);
    }
    if (live && slc_snapshot_is_good(io))
        exchange_fields(r, io, &nodes->at[index]);
    if (live && io->reading && slc_snapshot_is_good(io))
        count_page(r, &nodes->at[index]);
    io->part(io->user);
}

/** Exchanges the index of a node plus 1; 0 ends a list. Returns SLC_NO_NODE at the end and after an
 * error. */
static uint32_t exchange_index(struct slc_demand_residency *r, struct slc_snapshot_io *io,
                               uint32_t index)
{
    uint64_t at = io->reading || index == SLC_NO_NODE ? 0 : index + UINT64_C(1);
    at = slc_snapshot_number(io, at, r->nodes.end);
    return at ? (uint32_t)at - 1 : SLC_NO_NODE;
}

static bool is_live(const struct slc_demand_residency *r, uint32_t index)
{
    return slc_page_nodes_find(&r->nodes, r->nodes.at[index].page) == index;
}

static void exchange_free(struct slc_demand_residency *r, struct slc_snapshot_io *io)
{
    uint32_t tail = SLC_NO_NODE, next = r->nodes.free, index;
    while ((index = exchange_index(r, io, next)) != SLC_NO_NODE) {
        if (!io->reading)
            next = r->nodes.at[index].next[SLC_LINK_HOME];
        else if (is_live(r, index) || !slc_page_nodes_restore_order(&r->nodes, index, tail))
            slc_snapshot_fail(io, "the snapshot has a page that is free twice");
        tail = index;
    }
    io->part(io->user);
}

static void exchange_list(struct slc_demand_residency *r, struct slc_snapshot_io *io,
                          struct slc_page_list *list, enum slc_page_home home)
{
    uint32_t next = list->head, index;
    while ((index = exchange_index(r, io, next)) != SLC_NO_NODE) {
        if (!io->reading)
            next = r->nodes.at[index].next[SLC_LINK_HOME];
        else if (!is_live(r, index) || r->nodes.at[index].home != SLC_HOME_NONE)
            slc_snapshot_fail(io, "the snapshot has a page in two lists");
        else
            slc_page_list_append(&r->nodes, list, index, home);
    }
    io->part(io->user);
}

static void exchange_changes(struct slc_demand_residency *r, struct slc_snapshot_io *io)
{
    uint32_t next = r->changed_head, index;
    while ((index = exchange_index(r, io, next)) != SLC_NO_NODE) {
        struct slc_page_node *n = &r->nodes.at[index];
        if (!io->reading) {
            next = n->next[SLC_LINK_CHANGED];
            continue;
        }
        if (!is_live(r, index) || n->changed) {
            slc_snapshot_fail(io, "the snapshot has a change twice");
            return;
        }
        n->changed = true;
        n->next[SLC_LINK_CHANGED] = SLC_NO_NODE;
        if (r->changed_tail == SLC_NO_NODE)
            r->changed_head = index;
        else
            r->nodes.at[r->changed_tail].next[SLC_LINK_CHANGED] = index;
        r->changed_tail = index;
    }
    slc_snapshot_flag(io, &r->changes_sorted);
    io->part(io->user);
}

static void exchange_nodes(struct slc_demand_residency *r, struct slc_snapshot_io *io)
{
    uint32_t count = r->nodes.end;
    slc_snapshot_u32(io, &count, MOST_NODES);
    for (uint32_t i = 0; i < count && slc_snapshot_is_good(io); i++)
        exchange_node(r, io, i);
    exchange_free(r, io);
    for (uint32_t i = 0; i < r->lru_count; i++)
        exchange_list(r, io, &r->lrus[i].pages, SLC_HOME_LRU);
    for (uint32_t i = 0; i < r->class_count; i++)
        exchange_list(r, io, &r->classes[i].restorable, SLC_HOME_RESTORABLE);
    exchange_list(r, io, &r->unseen, SLC_HOME_UNSEEN);
    exchange_list(r, io, &r->overflow, SLC_HOME_OVERFLOW);
    exchange_changes(r, io);
}

/* Values of evicted pages without a place -------------------------------------------------------
 */

static void exchange_evicted(struct slc_demand_residency *r, struct slc_snapshot_io *io)
{
    uint32_t count = r->evicted_count;
    slc_snapshot_u32(io, &count, MOST_NODES);
    if (io->reading && slc_snapshot_is_good(io) && count + r->valued > 0) {
        r->evicted_capacity = slc_max_u32(64, count + r->valued);
        r->evicted = slc_alloc(&r->cb, r->evicted_capacity, sizeof *r->evicted);
        if (!r->evicted) {
            r->evicted_capacity = 0;
            io->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        }
    }
    for (uint32_t i = 0; i < count && slc_snapshot_is_good(io); i++) {
        struct slc_page_evicted *e = &r->evicted[(r->evicted_begin + i) % r->evicted_capacity];
        uint32_t class_index = io->reading ? 0 : e->class_index;
        if (io->reading)
            *e = (struct slc_page_evicted){0};
        slc_snapshot_u32(io, &e->page, UINT32_MAX);
        slc_snapshot_u32(io, &class_index, r->class_count - 1);
        slc_snapshot_u64(io, &e->value);
        if (io->reading) {
            e->class_index = (uint8_t)class_index;
            r->evicted_count++;
        }
        io->part(io->user);
    }
}

/* Classes, launches, and the bias ---------------------------------------------------------------
 */

static void exchange_classes(struct slc_demand_residency *r, const struct slc_page_memory *memory,
                             struct slc_snapshot_io *io)
{
    for (uint32_t i = 0; i < r->class_count; i++) {
        struct slc_page_class *c = &r->classes[i];
        slc_snapshot_u64(io, &c->limit);
        slc_snapshot_flag(io, &c->has_memory);
        slc_snapshot_u64(io, &c->counts.evicted);
        slc_snapshot_u64(io, &c->counts.restored);
        if (io->reading && c->has_memory)
            c->memory = *memory;
    }
    uint32_t count = r->lru_count;
    slc_snapshot_u32(io, &count, UINT32_MAX);
    for (uint32_t i = 0; i < count && slc_snapshot_is_good(io); i++) {
        uint32_t class_index = io->reading ? 0 : r->lrus[i].class_index;
        uint32_t kind = io->reading ? 0 : r->lrus[i].kind;
        slc_snapshot_u32(io, &class_index, r->class_count - 1);
        slc_snapshot_u32(io, &kind, UINT32_MAX);
        uint32_t lru = io->reading ? slc_residency_lru(r, class_index, kind) : i;
        if (lru == SLC_NO_LRU)
            io->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        else if (lru != i)
            slc_snapshot_fail(io, "the snapshot has a kind of pages twice");
        else
            slc_snapshot_u64(io, &r->lrus[i].sorted);
        io->part(io->user);
    }
}

static void exchange_bias(struct slc_demand_bias *b, struct slc_snapshot_io *io)
{
    slc_snapshot_u32(io, &b->quarters, SLC_MAX_BIAS_QUARTERS);
    slc_snapshot_u32(io, &b->raises, UINT32_MAX);
    slc_snapshot_u32(io, &b->calm, UINT32_MAX);
    slc_snapshot_flag(io, &b->on_trial);
    slc_snapshot_u32(io, &b->failed_trials, MOST_FAILED_TRIALS);
    slc_snapshot_flag(io, &b->settled);
    slc_snapshot_u64(io, &b->loads);
    for (uint32_t i = 0; i <= SLC_MAX_BIAS_QUARTERS; i++) {
        slc_snapshot_flag(io, &b->seen[i].known);
        slc_snapshot_flag(io, &b->seen[i].fails);
        slc_snapshot_flag(io, &b->seen[i].old);
        slc_snapshot_u32(io, &b->seen[i].need, MOST_BIAS_PAGES);
        slc_snapshot_u32(io, &b->seen[i].total, MOST_BIAS_PAGES);
        slc_snapshot_u32(io, &b->seen[i].scale, MOST_BIAS_PAGES);
    }
    io->part(io->user);
}

static void exchange_launch(struct slc_demand_residency *r, struct slc_snapshot_io *io)
{
    struct slc_launch_use *use = &r->use;
    slc_snapshot_u64(io, &r->launch);
    slc_snapshot_u64(io, &r->prepared);
    slc_snapshot_flag(io, &r->over_limit);
    slc_snapshot_u64(io, &use->used);
    slc_snapshot_u64(io, &use->used_pinned);
    slc_snapshot_u64(io, &use->touched);
    slc_snapshot_u64(io, &use->asked);
    slc_snapshot_u64(io, &use->pinned_waiting);
    slc_snapshot_u64(io, &use->requests);
    slc_snapshot_u64(io, &use->loads);
    slc_snapshot_flag(io, &use->refused);
    slc_snapshot_u64(io, &use->full_at);
    slc_snapshot_u64(io, &r->failed_loads);
    slc_snapshot_u64(io, &r->refused_idle);
    slc_snapshot_u64(io, &r->bias_from);
    slc_snapshot_flag(io, &r->bias_shown);
    exchange_bias(&r->bias, io);
}

static void exchange(struct slc_demand_residency *r, const struct slc_page_memory *memory,
                     struct slc_snapshot_io *io)
{
    exchange_classes(r, memory, io);
    exchange_nodes(r, io);
    exchange_evicted(r, io);
    exchange_launch(r, io);
}

void slc_residency_write_snapshot(const struct slc_demand_residency *residency,
                                  struct slc_snapshot_io *io)
{
    exchange((struct slc_demand_residency *)residency, NULL, io); /* does not change it */
}

void slc_residency_read_snapshot(struct slc_demand_residency *residency,
                                 const struct slc_page_memory *memory, struct slc_snapshot_io *io)
{
    exchange(residency, memory, io);
    residency->used = true;
    if (slc_snapshot_is_good(io) && !slc_residency_check(residency))
        slc_snapshot_fail(io, "no demand loading can be in the state of the snapshot");
}

void slc_residency_get_launches(const struct slc_demand_residency *residency, uint64_t *begun,
                                uint64_t *prepared)
{
    *begun = residency->launch;
    *prepared = residency->prepared;
}
