#include "demand/residency_internal.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

uint32_t slc_residency_pool(struct slc_demand_residency *r, uint32_t class_index, uint32_t kind)
{
    uint32_t pool = r->classes[class_index].first_pool;
    for (; pool != SLC_NO_POOL; pool = r->pools[pool].next)
        if (r->pools[pool].kind == kind)
            return pool;
    if (r->pool_count == r->pool_capacity) {
        uint32_t capacity = slc_max_u32(4, 2 * r->pool_capacity);
        struct slc_page_pool *pools =
            slc_regrow(&r->cb, r->pools, r->pool_capacity, capacity, sizeof *pools);
        if (!pools)
            return SLC_NO_POOL;
        r->pools = pools;
        r->pool_capacity = capacity;
    }
    r->pools[r->pool_count] = (struct slc_page_pool){.class_index = class_index,
                                                     .kind = kind,
                                                     .next = r->classes[class_index].first_pool,
                                                     .pages = slc_empty_page_list(),
                                                     .sorted = UINT64_MAX};
    r->classes[class_index].first_pool = r->pool_count;
    return r->pool_count++;
}

void slc_residency_enter_pool(struct slc_demand_residency *r, uint32_t index, uint64_t last_use)
{
    struct slc_page_node *node = slc_node(r, index);
    struct slc_page_list *pages = &r->pools[node->pool].pages;
    assert(node->state == SLC_PAGE_RESIDENT && !node->pinned);
    assert(pages->tail == SLC_NO_NODE || slc_node(r, pages->tail)->last_use <= last_use);
    node->last_use = last_use;
    slc_page_list_append(&r->nodes, pages, index, SLC_HOME_POOL);
}

void slc_residency_leave_home(struct slc_demand_residency *r, uint32_t index)
{
    struct slc_page_node *node = slc_node(r, index);
    switch ((enum slc_page_home)node->home) {
    case SLC_HOME_NONE: break;
    case SLC_HOME_POOL: slc_page_list_remove(&r->nodes, &r->pools[node->pool].pages, index); break;
    case SLC_HOME_UNSEEN: slc_page_list_remove(&r->nodes, &r->unseen, index); break;
    case SLC_HOME_GHOSTS:
        slc_page_list_remove(&r->nodes, &slc_class_of(r, index)->ghosts, index);
        break;
    case SLC_HOME_OVERFLOW: slc_page_list_remove(&r->nodes, &r->overflow, index); break;
    }
}

/* Pages that the same launch used last lie together at the head; nothing joins them any more once
 * a later launch has begun, and before that they are not evicted. */
static void sort_head(struct slc_demand_residency *r, struct slc_page_pool *pool)
{
    struct slc_page_node *at = r->nodes.at;
    struct slc_page_list *pages = &pool->pages;
    uint64_t launch = at[pages->head].last_use;
    if (pool->sorted == launch)
        return;
    pool->sorted = launch;
    uint32_t last = pages->head, previous = SLC_NO_NODE, head = pages->head;
    while (at[last].next[SLC_LINK_HOME] != SLC_NO_NODE &&
           at[at[last].next[SLC_LINK_HOME]].last_use == launch)
        last = at[last].next[SLC_LINK_HOME];
    uint32_t rest = at[last].next[SLC_LINK_HOME];
    at[last].next[SLC_LINK_HOME] = SLC_NO_NODE;
    pages->head = slc_page_nodes_sort(&r->nodes, head, SLC_LINK_HOME);
    for (uint32_t i = pages->head; i != SLC_NO_NODE; i = at[i].next[SLC_LINK_HOME]) {
        at[i].previous = previous;
        previous = i;
    }
    at[previous].next[SLC_LINK_HOME] = rest;
    if (rest != SLC_NO_NODE)
        at[rest].previous = previous;
    else
        pages->tail = previous;
}

static bool goes_before(const struct slc_page_node *a, const struct slc_page_node *b)
{
    if (a->last_use != b->last_use)
        return a->last_use < b->last_use;
    return a->rank != b->rank ? a->rank > b->rank : a->page < b->page;
}

/* SLC_NO_NODE if all of the pool were used by the launch. */
static uint32_t first_to_go(struct slc_demand_residency *r, struct slc_page_pool *pool)
{
    if (pool->pages.head == SLC_NO_NODE || slc_node(r, pool->pages.head)->last_use >= r->launch)
        return SLC_NO_NODE;
    sort_head(r, pool);
    return pool->pages.head;
}

bool slc_residency_evict(struct slc_demand_residency *r, uint32_t class_index, uint32_t pool)
{
    uint32_t best = SLC_NO_NODE;
    if (r->no_eviction)
        return false;
    for (uint32_t p = r->classes[class_index].first_pool; p != SLC_NO_POOL; p = r->pools[p].next) {
        uint32_t node =
            pool == SLC_NO_POOL || pool == p ? first_to_go(r, &r->pools[p]) : SLC_NO_NODE;
        if (node != SLC_NO_NODE &&
            (best == SLC_NO_NODE || goes_before(slc_node(r, node), slc_node(r, best))))
            best = node;
    }
    if (best == SLC_NO_NODE)
        return false;
    slc_residency_leave_home(r, best);
    slc_residency_release(r, best, true);
    slc_residency_note(r, best);
    r->classes[class_index].counts.evicted++;
    return true;
}

void slc_residency_trim(struct slc_demand_residency *r, uint32_t class_index)
{
    struct slc_page_class *c = &r->classes[class_index];
    while (c->held > c->limit)
        if (!slc_residency_evict(r, class_index, SLC_NO_POOL))
            return;
}
