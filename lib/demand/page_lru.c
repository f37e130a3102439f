#include "demand/page_lru.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

uint32_t slc_residency_lru(struct slc_demand_residency *r, uint32_t class_index, uint32_t kind)
{
    uint32_t lru = r->classes[class_index].first_lru;
    for (; lru != SLC_NO_LRU; lru = r->lrus[lru].next)
        if (r->lrus[lru].kind == kind)
            return lru;
    if (r->lru_count == r->lru_capacity) {
        uint32_t capacity = slc_max_u32(4, 2 * r->lru_capacity);
        struct slc_page_lru *lrus =
            slc_regrow(&r->cb, r->lrus, r->lru_capacity, capacity, sizeof *lrus);
        if (!lrus)
            return SLC_NO_LRU;
        r->lrus = lrus;
        r->lru_capacity = capacity;
    }
    r->lrus[r->lru_count] = (struct slc_page_lru){.class_index = class_index,
                                                  .kind = kind,
                                                  .next = r->classes[class_index].first_lru,
                                                  .pages = slc_empty_page_list(),
                                                  .sorted = UINT64_MAX};
    r->classes[class_index].first_lru = r->lru_count;
    return r->lru_count++;
}

void slc_residency_enter_lru(struct slc_demand_residency *r, uint32_t index, uint64_t last_use)
{
    struct slc_page_node *node = slc_node(r, index);
    struct slc_page_list *pages = &r->lrus[node->lru].pages;
    assert(node->state == SLC_PAGE_RESIDENT && !node->pinned);
    assert(pages->tail == SLC_NO_NODE || slc_node(r, pages->tail)->last_use <= last_use);
    node->last_use = last_use;
    slc_page_list_append(&r->nodes, pages, index, SLC_HOME_LRU);
}

void slc_residency_leave_home(struct slc_demand_residency *r, uint32_t index)
{
    struct slc_page_node *node = slc_node(r, index);
    switch ((enum slc_page_home)node->home) {
    case SLC_HOME_NONE: break;
    case SLC_HOME_LRU: slc_page_list_remove(&r->nodes, &r->lrus[node->lru].pages, index); break;
    case SLC_HOME_UNSEEN: slc_page_list_remove(&r->nodes, &r->unseen, index); break;
    case SLC_HOME_RESTORABLE:
        slc_page_list_remove(&r->nodes, &slc_class_of(r, index)->restorable, index);
        break;
    case SLC_HOME_OVERFLOW: slc_page_list_remove(&r->nodes, &r->overflow, index); break;
    }
}
