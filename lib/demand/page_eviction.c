#include "demand/page_eviction.h"

#include "demand/page_changes.h"
#include "demand/page_lru.h"
#include "demand/page_release.h"

/* Sorts the pages at the head of the list that one launch used last. Their number does not grow
 * once a later launch has begun. Before that, they are not evicted. */
static void sort_head(struct slc_demand_residency *r, struct slc_page_lru *lru)
{
    struct slc_page_node *at = r->nodes.at;
    struct slc_page_list *pages = &lru->pages;
    uint64_t launch = at[pages->head].last_use;
    if (lru->sorted == launch)
        return;
    lru->sorted = launch;
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

/* Returns the first page to evict; SLC_NO_NODE if the launch used all pages of the list. */
static uint32_t first_to_go(struct slc_demand_residency *r, struct slc_page_lru *lru)
{
    if (lru->pages.head == SLC_NO_NODE || slc_node(r, lru->pages.head)->last_use >= r->launch)
        return SLC_NO_NODE;
    sort_head(r, lru);
    return lru->pages.head;
}

bool slc_residency_evict(struct slc_demand_residency *r, uint32_t class_index, uint32_t lru)
{
    uint32_t best = SLC_NO_NODE;
    if (r->no_eviction)
        return false;
    for (uint32_t p = r->classes[class_index].first_lru; p != SLC_NO_LRU; p = r->lrus[p].next) {
        uint32_t node = lru == SLC_NO_LRU || lru == p ? first_to_go(r, &r->lrus[p]) : SLC_NO_NODE;
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

uint64_t slc_residency_oldest_use(const struct slc_demand_residency *residency,
                                  uint32_t class_index)
{
    const struct slc_demand_residency *r = residency;
    uint64_t oldest = UINT64_MAX;
    if (r->no_eviction)
        return oldest;
    for (uint32_t p = r->classes[class_index].first_lru; p != SLC_NO_LRU; p = r->lrus[p].next) {
        uint32_t head = r->lrus[p].pages.head;
        if (head != SLC_NO_NODE && r->nodes.at[head].last_use < oldest)
            oldest = r->nodes.at[head].last_use;
    }
    return oldest < r->launch ? oldest : UINT64_MAX;
}

void slc_residency_trim(struct slc_demand_residency *r, uint32_t class_index)
{
    struct slc_page_class *c = &r->classes[class_index];
    while (c->held > c->limit)
        if (!slc_residency_evict(r, class_index, SLC_NO_LRU))
            return;
}
