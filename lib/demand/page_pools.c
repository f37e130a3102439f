#include "demand/page_pools.h"

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
