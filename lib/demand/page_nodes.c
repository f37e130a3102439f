#include "demand/page_nodes.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

#define FIRST_CAPACITY 64u
#define MAX_CAPACITY (1u << 29)

SluiceResult slc_page_nodes_init(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb)
{
    *nodes = (struct slc_page_nodes){.free = SLC_NO_NODE};
    return slc_map_init(&nodes->map, cb, FIRST_CAPACITY);
}

void slc_page_nodes_finish(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, nodes->at, nodes->capacity, sizeof *nodes->at);
    slc_map_finish(&nodes->map, cb);
    *nodes = (struct slc_page_nodes){.free = SLC_NO_NODE};
}

bool slc_page_nodes_reserve(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb)
{
    if (nodes->count == nodes->map.capacity &&
        (nodes->count >= MAX_CAPACITY ||
         slc_map_reserve(&nodes->map, cb, 2 * nodes->count) != SLUICE_SUCCESS))
        return false;
    if (nodes->free != SLC_NO_NODE || nodes->end < nodes->capacity)
        return true;
    uint32_t capacity = slc_max_u32(FIRST_CAPACITY, 2 * nodes->capacity);
    struct slc_page_node *at =
        slc_regrow(cb, nodes->at, nodes->capacity, capacity, sizeof *nodes->at);
    if (!at)
        return false;
    nodes->at = at;
    nodes->capacity = capacity;
    return true;
}

uint32_t slc_page_nodes_add(struct slc_page_nodes *nodes, uint32_t page)
{
    uint32_t index = nodes->free;
    if (index != SLC_NO_NODE)
        nodes->free = nodes->at[index].next[SLC_LINK_HOME];
    else
        index = nodes->end++;
    assert(index < nodes->capacity);
    nodes->at[index] = (struct slc_page_node){
        .page = page, .place = SLC_NO_PLACE, .state = SLC_PAGE_ABSENT, .home = SLC_HOME_NONE};
    nodes->count++;
    slc_map_add(&nodes->map, page, index);
    return index;
}

void slc_page_nodes_remove(struct slc_page_nodes *nodes, uint32_t index)
{
    struct slc_page_node *node = &nodes->at[index];
    assert(node->home == SLC_HOME_NONE && !node->changed);
    slc_map_remove(&nodes->map, node->page);
    node->next[SLC_LINK_HOME] = nodes->free;
    nodes->free = index;
    nodes->count--;
}

#define UNLISTED (SLC_NO_NODE - 1)

void slc_page_nodes_restore_free(struct slc_page_nodes *nodes)
{
    assert(nodes->end < nodes->capacity);
    nodes->at[nodes->end++] = (struct slc_page_node){.previous = UNLISTED};
}

bool slc_page_nodes_restore_order(struct slc_page_nodes *nodes, uint32_t index, uint32_t tail)
{
    struct slc_page_node *node = &nodes->at[index];
    if (node->previous != UNLISTED)
        return false;
    node->previous = SLC_NO_NODE;
    node->next[SLC_LINK_HOME] = SLC_NO_NODE;
    if (tail == SLC_NO_NODE)
        nodes->free = index;
    else
        nodes->at[tail].next[SLC_LINK_HOME] = index;
    return true;
}

uint32_t slc_page_nodes_find(const struct slc_page_nodes *nodes, uint32_t page)
{
    return slc_map_get(&nodes->map, page);
}

void slc_page_list_append(struct slc_page_nodes *nodes, struct slc_page_list *list, uint32_t index,
                          enum slc_page_home home)
{
    struct slc_page_node *node = &nodes->at[index];
    assert(node->home == SLC_HOME_NONE);
    node->home = (uint8_t)home;
    node->previous = list->tail;
    node->next[SLC_LINK_HOME] = SLC_NO_NODE;
    if (list->tail != SLC_NO_NODE)
        nodes->at[list->tail].next[SLC_LINK_HOME] = index;
    else
        list->head = index;
    list->tail = index;
    list->count++;
}

void slc_page_list_remove(struct slc_page_nodes *nodes, struct slc_page_list *list, uint32_t index)
{
    struct slc_page_node *node = &nodes->at[index];
    uint32_t next = node->next[SLC_LINK_HOME], previous = node->previous;
    assert(node->home != SLC_HOME_NONE && list->count > 0);
    if (previous != SLC_NO_NODE)
        nodes->at[previous].next[SLC_LINK_HOME] = next;
    else
        list->head = next;
    if (next != SLC_NO_NODE)
        nodes->at[next].previous = previous;
    else
        list->tail = previous;
    list->count--;
    node->home = SLC_HOME_NONE;
}

static uint64_t sort_key(const struct slc_page_node *node, enum slc_page_link link)
{
    uint32_t rank = link == SLC_LINK_HOME ? UINT8_MAX - (uint32_t)node->rank : 0;
    return (uint64_t)rank << 32 | node->page;
}

static uint32_t merge(struct slc_page_node *at, uint32_t a, uint32_t b, enum slc_page_link link)
{
    uint32_t head = SLC_NO_NODE, *end = &head;
    while (a != SLC_NO_NODE && b != SLC_NO_NODE) {
        uint32_t *least = sort_key(&at[a], link) <= sort_key(&at[b], link) ? &a : &b;
        *end = *least;
        end = &at[*least].next[link];
        *least = *end;
    }
    *end = a != SLC_NO_NODE ? a : b;
    return head;
}

/* Cuts off the sorted beginning of a chain. *rest: head of the remaining chain. */
static void cut_run(struct slc_page_node *at, uint32_t head, enum slc_page_link link,
                    uint32_t *rest)
{
    uint32_t next = at[head].next[link];
    while (next != SLC_NO_NODE && sort_key(&at[head], link) <= sort_key(&at[next], link)) {
        head = next;
        next = at[head].next[link];
    }
    at[head].next[link] = SLC_NO_NODE;
    *rest = next;
}

uint32_t slc_page_nodes_sort(struct slc_page_nodes *nodes, uint32_t head, enum slc_page_link link)
{
    uint32_t bins[32], used = 0; /* bin i: 2^i runs merged, or none */
    while (head != SLC_NO_NODE) {
        uint32_t run = head, bin = 0;
        cut_run(nodes->at, run, link, &head);
        for (; bin < used && bins[bin] != SLC_NO_NODE; bin++) {
            run = merge(nodes->at, bins[bin], run, link);
            bins[bin] = SLC_NO_NODE;
        }
        if (bin == used)
            used++;
        assert(used <= 32);
        bins[bin] = run;
    }
    for (uint32_t bin = 0; bin < used; bin++)
        head = merge(nodes->at, bins[bin], head, link);
    return head;
}
