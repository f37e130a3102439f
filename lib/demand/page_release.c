#include "demand/page_release.h"

#include "demand/page_changes.h"
#include "demand/page_lru.h"

#include <assert.h>

#define LEAST_RESTORABLE 64u

static void drop_restorable(struct slc_demand_residency *r, uint32_t index)
{
    slc_residency_leave_home(r, index);
    slc_node(r, index)->place = SLC_NO_PLACE;
    slc_residency_note(r, index);
}

void slc_residency_become_restorable(struct slc_demand_residency *r, uint32_t index, uint32_t place)
{
    struct slc_page_class *c = slc_class_of(r, index);
    slc_node(r, index)->place = place;
    slc_page_list_append(&r->nodes, &c->restorable, index, SLC_HOME_RESTORABLE);
    /* other pages have taken most places of pages evicted long ago */
    while (c->restorable.count > LEAST_RESTORABLE && c->restorable.count > c->held)
        drop_restorable(r, c->restorable.head);
}

static void give_place(struct slc_demand_residency *r, uint32_t index, bool evicted)
{
    struct slc_page_class *c = slc_class_of(r, index);
    struct slc_page_node *node = slc_node(r, index);
    uint32_t place = node->place, page = evicted ? node->page : SLC_NO_PAGE;
    c->memory.give(c->memory.user, place, page);
    SLC_TELL_PAGES(r, .kind = SLC_PAGE_CALL_GIVE, .place = place, .page = page);
    if (evicted)
        slc_residency_become_restorable(r, index, node->place);
    else
        node->place = SLC_NO_PLACE;
}

static void give_value(struct slc_demand_residency *r, const struct slc_page_node *node)
{
    r->valued--;
    if (node->state != SLC_PAGE_RESIDENT)
        return;
    assert(r->evicted_count < r->evicted_capacity);
    uint32_t at = (r->evicted_begin + r->evicted_count++) % r->evicted_capacity;
    r->evicted[at] = (struct slc_page_evicted){node->page, node->class_index, node->value};
}

void slc_residency_release(struct slc_demand_residency *r, uint32_t index, bool evicted)
{
    struct slc_page_class *c = slc_class_of(r, index);
    struct slc_page_node *node = slc_node(r, index);
    assert(node->state == SLC_PAGE_LOADING || node->state == SLC_PAGE_RESIDENT);
    assert(node->home == SLC_HOME_NONE);
    bool resident = node->state == SLC_PAGE_RESIDENT;
    if (!c->has_memory)
        give_value(r, node);
    c->counts.resident -= resident;
    c->counts.loading -= !resident;
    c->held--;
    c->pinned -= node->pinned;
    node->pinned = false;
    node->dropped = false;
    node->state = SLC_PAGE_ABSENT;
    if (c->has_memory)
        give_place(r, index, evicted);
}

static void become_resident(struct slc_demand_residency *r, uint32_t index, uint64_t value)
{
    struct slc_page_node *node = slc_node(r, index);
    struct slc_page_class *c = slc_class_of(r, index);
    node->state = SLC_PAGE_RESIDENT;
    node->value = c->has_memory ? node->place : value;
    node->last_use = r->launch;
    c->counts.loading--;
    c->counts.resident++;
}

void slc_residency_loaded(struct slc_demand_residency *residency, uint32_t page, uint64_t value)
{
    uint32_t index = slc_page_nodes_find(&residency->nodes, page);
    assert(index != SLC_NO_NODE && slc_node(residency, index)->state == SLC_PAGE_LOADING);
    become_resident(residency, index, value);
    if (slc_node(residency, index)->dropped)
        slc_residency_release(residency, index, false);
    slc_residency_note(residency, index);
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_LOADED, .page = page, .value = value);
}

void slc_residency_failed(struct slc_demand_residency *residency, uint32_t page, bool refuse)
{
    uint32_t index = slc_page_nodes_find(&residency->nodes, page);
    assert(index != SLC_NO_NODE && slc_node(residency, index)->state == SLC_PAGE_LOADING);
    struct slc_page_node *node = slc_node(residency, index);
    bool refused = refuse && !node->dropped;
    residency->failed_loads += node->class_index == SLC_TILES;
    slc_residency_release(residency, index, false);
    if (refused) {
        node->state = SLC_PAGE_REFUSED;
        slc_class_of(residency, index)->counts.refused++;
    }
    slc_residency_note(residency, index);
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_FAILED, .page = page, .flag = refuse);
}

static void forget(struct slc_demand_residency *r, uint32_t index)
{
    struct slc_page_node *node = slc_node(r, index);
    switch ((enum slc_page_state)node->state) {
    case SLC_PAGE_ABSENT:
        if (node->home == SLC_HOME_RESTORABLE)
            drop_restorable(r, index);
        break;
    case SLC_PAGE_LOADING: node->dropped = true; break;
    case SLC_PAGE_RESIDENT:
        slc_residency_leave_home(r, index);
        slc_residency_release(r, index, false);
        slc_residency_note(r, index);
        break;
    case SLC_PAGE_REFUSED:
        slc_residency_leave_home(r, index);
        slc_class_of(r, index)->counts.refused--;
        node->state = SLC_PAGE_ABSENT;
        slc_residency_note(r, index);
        break;
    }
}

static void forget_range(struct slc_demand_residency *residency, uint32_t first, uint64_t count)
{
    struct slc_page_nodes *nodes = &residency->nodes;
    if (count > nodes->end) { /* fewer nodes than ids */
        for (uint32_t i = 0; i < nodes->end; i++) {
            uint32_t page = nodes->at[i].page;
            if (page >= first && page - first < count && slc_page_nodes_find(nodes, page) == i)
                forget(residency, i);
        }
        return;
    }
    for (uint64_t i = 0; i < count; i++) {
        uint32_t index = slc_page_nodes_find(nodes, (uint32_t)(first + i));
        if (index != SLC_NO_NODE)
            forget(residency, index);
    }
}

void slc_residency_forget(struct slc_demand_residency *residency, uint32_t first, uint64_t count)
{
    forget_range(residency, first, count);
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_FORGET, .page = first, .count = count);
}

bool slc_residency_retry(struct slc_demand_residency *residency, uint32_t page)
{
    uint32_t index = slc_page_nodes_find(&residency->nodes, page);
    bool refused = index != SLC_NO_NODE && slc_node(residency, index)->state == SLC_PAGE_REFUSED;
    if (refused)
        forget(residency, index);
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_RETRY, .page = page, .answer = refused);
    return refused;
}
