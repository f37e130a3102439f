#include "demand/page_changes.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

static enum slc_page_shown shown_now(const struct slc_page_node *node)
{
    switch ((enum slc_page_state)node->state) {
    case SLC_PAGE_RESIDENT: return SLC_SHOW_RESIDENT;
    case SLC_PAGE_REFUSED: return SLC_SHOW_REFUSED;
    case SLC_PAGE_ABSENT:
    case SLC_PAGE_LOADING: break;
    }
    return SLC_SHOW_ABSENT;
}

static bool is_shown(const struct slc_page_node *node)
{
    enum slc_page_shown now = shown_now(node);
    return now == (enum slc_page_shown)node->shown &&
           (now != SLC_SHOW_RESIDENT || node->value == node->shown_value);
}

static void drop_if_useless(struct slc_demand_residency *r, uint32_t index)
{
    const struct slc_page_node *node = slc_node(r, index);
    if (node->state == SLC_PAGE_ABSENT && node->home == SLC_HOME_NONE && !node->changed)
        slc_page_nodes_remove(&r->nodes, index);
}

void slc_residency_note(struct slc_demand_residency *r, uint32_t index)
{
    struct slc_page_node *node = slc_node(r, index);
    /* Resident pages in no list wait to be shown, even if the page table shows them already. */
    bool waits = node->state == SLC_PAGE_RESIDENT && node->home == SLC_HOME_NONE && !node->pinned;
    if (!node->changed && (waits || !is_shown(node))) {
        node->changed = true;
        node->next[SLC_LINK_CHANGED] = SLC_NO_NODE;
        if (r->changed_tail != SLC_NO_NODE)
            slc_node(r, r->changed_tail)->next[SLC_LINK_CHANGED] = index;
        else
            r->changed_head = index;
        r->changed_tail = index;
        r->changes_sorted = false;
    }
    drop_if_useless(r, index);
}

static uint32_t pop_changed(struct slc_demand_residency *r)
{
    uint32_t index = r->changed_head;
    struct slc_page_node *node = slc_node(r, index);
    r->changed_head = node->next[SLC_LINK_CHANGED];
    if (r->changed_head == SLC_NO_NODE)
        r->changed_tail = SLC_NO_NODE;
    node->changed = false;
    return index;
}

static void sort_changes(struct slc_demand_residency *r)
{
    if (r->changes_sorted)
        return;
    r->changed_head = slc_page_nodes_sort(&r->nodes, r->changed_head, SLC_LINK_CHANGED);
    r->changed_tail = r->changed_head;
    while (r->changed_tail != SLC_NO_NODE &&
           slc_node(r, r->changed_tail)->next[SLC_LINK_CHANGED] != SLC_NO_NODE)
        r->changed_tail = slc_node(r, r->changed_tail)->next[SLC_LINK_CHANGED];
    r->changes_sorted = true;
}

/* Makes a page evictable from the next launch on, which can use it. */
static void wait_for_launch(struct slc_demand_residency *r, uint32_t index)
{
    struct slc_page_node *node = slc_node(r, index);
    if (node->state != SLC_PAGE_RESIDENT || node->home != SLC_HOME_NONE || node->pinned)
        return;
    node->visible_from = r->prepared > r->launch ? r->prepared : r->launch + 1;
    slc_page_list_append(&r->nodes, &r->unseen, index, SLC_HOME_UNSEEN);
}

uint32_t slc_residency_take_changes(struct slc_demand_residency *residency,
                                    struct slc_page_change *changes, uint32_t capacity)
{
    uint32_t count = 0;
    sort_changes(residency);
    while (count < capacity && residency->changed_head != SLC_NO_NODE) {
        uint32_t index = pop_changed(residency);
        struct slc_page_node *node = slc_node(residency, index);
        if (!is_shown(node)) {
            changes[count++] = (struct slc_page_change){.page = node->page,
                                                        .shown = shown_now(node),
                                                        .value = node->value,
                                                        .class_index = node->class_index};
            node->shown = (uint8_t)shown_now(node);
            node->shown_value = node->value;
        }
        wait_for_launch(residency, index);
        drop_if_useless(residency, index);
    }
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_TAKE_CHANGES, .capacity = capacity,
                   .count = count, .changes = changes);
    return count;
}

bool slc_residency_reserve_evicted(struct slc_demand_residency *r)
{
    uint32_t capacity = r->evicted_capacity;
    if (r->evicted_count + r->valued < capacity)
        return true;
    uint32_t larger = slc_max_u32(64, 2 * capacity);
    struct slc_page_evicted *evicted = slc_alloc(&r->cb, larger, sizeof *evicted);
    if (!evicted)
        return false;
    for (uint32_t i = 0; i < r->evicted_count; i++)
        evicted[i] = r->evicted[(r->evicted_begin + i) % capacity];
    slc_free(&r->cb, r->evicted, capacity, sizeof *evicted);
    r->evicted = evicted;
    r->evicted_capacity = larger;
    r->evicted_begin = 0;
    return true;
}

uint32_t slc_residency_take_evicted(struct slc_demand_residency *residency,
                                    struct slc_page_evicted *evicted, uint32_t capacity)
{
    uint32_t count = 0;
    for (; count < capacity && residency->evicted_count > 0; count++) {
        evicted[count] = residency->evicted[residency->evicted_begin];
        residency->evicted_begin = (residency->evicted_begin + 1) % residency->evicted_capacity;
        residency->evicted_count--;
    }
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_TAKE_EVICTED, .capacity = capacity,
                   .count = count, .evicted = evicted);
    return count;
}
