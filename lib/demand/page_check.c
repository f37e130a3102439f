#include "demand/page_state.h"

#define REQUIRE(condition)                                                                         \
    do {                                                                                           \
        if (!(condition))                                                                          \
            return false;                                                                          \
    } while (0)

static bool check_list(const struct slc_demand_residency *r, const struct slc_page_list *list,
                       enum slc_page_home home)
{
    uint32_t count = 0, previous = SLC_NO_NODE;
    for (uint32_t i = list->head; i != SLC_NO_NODE; i = r->nodes.at[i].next[SLC_LINK_HOME]) {
        REQUIRE(r->nodes.at[i].home == home && r->nodes.at[i].previous == previous);
        REQUIRE(count++ < r->nodes.end);
        previous = i;
    }
    REQUIRE(list->tail == previous);
    return list->count == count;
}

static bool check_lru(const struct slc_demand_residency *r, uint32_t lru)
{
    uint64_t last = 0;
    const struct slc_page_list *pages = &r->lrus[lru].pages;
    REQUIRE(check_list(r, pages, SLC_HOME_LRU));
    for (uint32_t i = pages->head; i != SLC_NO_NODE; i = r->nodes.at[i].next[SLC_LINK_HOME]) {
        const struct slc_page_node *node = &r->nodes.at[i];
        REQUIRE(node->lru == lru && node->class_index == r->lrus[lru].class_index);
        REQUIRE(node->last_use >= last && node->last_use <= r->launch);
        last = node->last_use;
    }
    return true;
}

static bool check_class(const struct slc_demand_residency *r, const struct slc_page_list *list,
                        uint32_t class_index)
{
    for (uint32_t i = list->head; i != SLC_NO_NODE; i = r->nodes.at[i].next[SLC_LINK_HOME])
        REQUIRE(r->nodes.at[i].class_index == class_index);
    return true;
}

static bool check_lists(const struct slc_demand_residency *r)
{
    uint64_t restorable = 0, listed = r->unseen.count + r->overflow.count;
    uint64_t homes = 0;
    for (uint32_t p = 0; p < r->lru_count; p++) {
        REQUIRE(check_lru(r, p));
        listed += r->lrus[p].pages.count;
    }
    for (uint32_t c = 0; c < r->class_count; c++) {
        REQUIRE(check_list(r, &r->classes[c].restorable, SLC_HOME_RESTORABLE));
        REQUIRE(check_class(r, &r->classes[c].restorable, c));
        restorable += r->classes[c].restorable.count;
    }
    REQUIRE(check_list(r, &r->unseen, SLC_HOME_UNSEEN));
    REQUIRE(check_list(r, &r->overflow, SLC_HOME_OVERFLOW));
    REQUIRE(check_class(r, &r->overflow, SLC_TILES));
    for (uint32_t i = 0; i < r->nodes.end; i++)
        if (slc_page_nodes_find(&r->nodes, r->nodes.at[i].page) == i)
            homes += r->nodes.at[i].home != SLC_HOME_NONE;
    return homes == restorable + listed;
}

/* Checks a node without its lists. */
static bool check_node(const struct slc_demand_residency *r, const struct slc_page_node *node)
{
    REQUIRE(node->class_index < r->class_count);
    bool has_memory = r->classes[node->class_index].has_memory;
    bool held = node->state == SLC_PAGE_LOADING || node->state == SLC_PAGE_RESIDENT;
    REQUIRE(held || (!node->pinned && !node->dropped));
    REQUIRE((node->place != SLC_NO_PLACE) ==
            ((held && has_memory) || node->home == SLC_HOME_RESTORABLE));
    switch ((enum slc_page_state)node->state) {
    case SLC_PAGE_ABSENT: return node->changed || node->home == SLC_HOME_RESTORABLE;
    case SLC_PAGE_LOADING: return node->home == SLC_HOME_NONE;
    case SLC_PAGE_RESIDENT:
        REQUIRE(!has_memory || node->value == node->place);
        if (node->home == SLC_HOME_NONE)
            return node->pinned || node->changed;
        return !node->pinned && (node->home == SLC_HOME_LRU || node->home == SLC_HOME_UNSEEN);
    case SLC_PAGE_REFUSED: return node->home == SLC_HOME_NONE || node->home == SLC_HOME_OVERFLOW;
    }
    return false;
}

static bool check_counts(const struct slc_demand_residency *r, uint32_t class_index)
{
    const struct slc_page_class *c = &r->classes[class_index];
    uint64_t states[SLC_PAGE_REFUSED + 1] = {0}, pinned = 0;
    for (uint32_t i = 0; i < r->nodes.end; i++) {
        const struct slc_page_node *node = &r->nodes.at[i];
        if (slc_page_nodes_find(&r->nodes, node->page) != i || node->class_index != class_index)
            continue;
        states[node->state]++;
        pinned += node->pinned;
    }
    REQUIRE(states[SLC_PAGE_LOADING] == c->counts.loading);
    REQUIRE(states[SLC_PAGE_RESIDENT] == c->counts.resident);
    REQUIRE(states[SLC_PAGE_REFUSED] == c->counts.refused);
    REQUIRE(c->held == c->counts.loading + c->counts.resident);
    REQUIRE(c->held <= c->limit || r->over_limit);
    return pinned == c->pinned;
}

static bool check_changes(const struct slc_demand_residency *r)
{
    uint32_t listed = 0, changed = 0, tail = SLC_NO_NODE;
    for (uint32_t i = r->changed_head; i != SLC_NO_NODE;
         i = r->nodes.at[i].next[SLC_LINK_CHANGED]) {
        REQUIRE(r->nodes.at[i].changed && listed++ < r->nodes.end);
        tail = i;
    }
    for (uint32_t i = 0; i < r->nodes.end; i++)
        if (slc_page_nodes_find(&r->nodes, r->nodes.at[i].page) == i)
            changed += r->nodes.at[i].changed;
    return listed == changed && tail == r->changed_tail;
}

bool slc_residency_check(const struct slc_demand_residency *residency)
{
    const struct slc_demand_residency *r = residency;
    uint32_t live = 0;
    uint64_t valued = 0;
    for (uint32_t i = 0; i < r->nodes.end; i++) {
        const struct slc_page_node *node = &r->nodes.at[i];
        if (slc_page_nodes_find(&r->nodes, node->page) != i)
            continue;
        REQUIRE(check_node(r, node));
        live++;
    }
    REQUIRE(live == r->nodes.count && live == r->nodes.map.count);
    for (uint32_t c = 0; c < r->class_count; c++) {
        REQUIRE(check_counts(r, c));
        valued += r->classes[c].has_memory ? 0 : r->classes[c].held;
    }
    REQUIRE(valued == r->valued && r->evicted_count + valued <= r->evicted_capacity);
    return check_lists(r) && check_changes(r);
}
