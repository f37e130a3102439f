#include "base/alloc.h"
#include "demand/page_eviction.h"

#include <assert.h>

SluiceResult slc_residency_create(const struct slc_page_residency_create_info *info,
                                  struct slc_demand_residency **residency)
{
    assert(info->class_count > 0 && info->class_count <= UINT8_MAX + 1u);
    SluiceAllocationCallbacks cb = slc_allocator(info->cb);
    struct slc_demand_residency *r = slc_calloc(&cb, 1, sizeof *r);
    if (!r)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    r->cb = cb;
    r->no_eviction = info->no_eviction;
    r->no_lod_bias = info->no_lod_bias;
    r->unseen = r->overflow = slc_empty_page_list();
    r->changed_head = r->changed_tail = SLC_NO_NODE;
    r->use.full_at = UINT64_MAX;
    r->bias_shown = true;
    r->classes = slc_calloc(&cb, info->class_count, sizeof *r->classes);
    r->class_count = r->classes ? info->class_count : 0;
    if (!r->classes || slc_page_nodes_init(&r->nodes, &cb) != SLUICE_SUCCESS) {
        slc_residency_destroy(r);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    for (uint32_t i = 0; i < r->class_count; i++)
        r->classes[i] = (struct slc_page_class){
            .limit = UINT64_MAX, .first_lru = SLC_NO_LRU, .restorable = slc_empty_page_list()};
    *residency = r;
    return SLUICE_SUCCESS;
}

void slc_residency_destroy(struct slc_demand_residency *residency)
{
    if (!residency)
        return;
    SluiceAllocationCallbacks cb = residency->cb;
    slc_page_nodes_finish(&residency->nodes, &cb);
    slc_free(&cb, residency->classes, residency->class_count, sizeof *residency->classes);
    slc_free(&cb, residency->lrus, residency->lru_capacity, sizeof *residency->lrus);
    slc_free(&cb, residency->evicted, residency->evicted_capacity, sizeof *residency->evicted);
    slc_free(&cb, residency, 1, sizeof *residency);
}

SluiceResult slc_residency_set_class(struct slc_demand_residency *residency, uint32_t class_index,
                                     uint64_t limit, const struct slc_page_memory *memory)
{
    assert(class_index < residency->class_count);
    struct slc_page_class *c = &residency->classes[class_index];
    assert(c->held == 0 || c->has_memory == (memory != NULL));
    c->limit = limit;
    c->has_memory = memory != NULL;
    if (memory)
        c->memory = *memory;
    slc_residency_trim(residency, class_index);
    residency->over_limit |= c->held > c->limit;
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_SET_CLASS, .class_index = (uint8_t)class_index,
                   .value = limit, .flag = memory != NULL);
    return SLUICE_SUCCESS;
}

void slc_residency_set_switches(struct slc_demand_residency *residency, bool no_eviction,
                                bool no_lod_bias)
{
    struct slc_demand_residency *r = residency;
    r->no_eviction = no_eviction;
    r->no_lod_bias = no_lod_bias;
    if ((no_eviction || no_lod_bias) && r->bias.quarters) {
        r->bias = (struct slc_demand_bias){0};
        r->bias_shown = false;
    }
    SLC_TELL_PAGES(r, .kind = SLC_PAGE_CALL_SET_SWITCHES, .flag = no_eviction,
                   .answer = no_lod_bias);
}

void slc_residency_visit_placed(const struct slc_demand_residency *residency, uint32_t class_index,
                                void (*visit)(void *user, const struct slc_placed_page *page),
                                void *user)
{
    for (uint32_t i = 0; i < residency->nodes.end; i++) {
        const struct slc_page_node *node = &residency->nodes.at[i];
        bool resident = node->state == SLC_PAGE_RESIDENT;
        if (node->class_index != class_index || (!resident && node->state != SLC_PAGE_LOADING))
            continue;
        const struct slc_placed_page page = {.page = node->page,
                                             .place = node->place,
                                             .stays = node->home != SLC_HOME_LRU,
                                             .in_use = node->last_use >= residency->launch};
        visit(user, &page);
    }
}

void slc_residency_get_counts(const struct slc_demand_residency *residency, uint32_t class_index,
                              struct slc_residency_counts *counts)
{
    assert(class_index < residency->class_count);
    *counts = residency->classes[class_index].counts;
}

bool slc_residency_is_resident(const struct slc_demand_residency *residency, uint32_t page,
                               uint32_t *place)
{
    uint32_t index = slc_page_nodes_find(&residency->nodes, page);
    if (index == SLC_NO_NODE || residency->nodes.at[index].state != SLC_PAGE_RESIDENT)
        return false;
    *place = residency->nodes.at[index].place;
    return true;
}

uint32_t slc_residency_known_count(const struct slc_demand_residency *residency)
{
    return residency->nodes.end;
}

void slc_residency_visit(const struct slc_demand_residency *residency,
                         void (*visit)(void *user, uint32_t page), void *user)
{
    const struct slc_page_nodes *nodes = &residency->nodes;
    for (uint32_t i = 0; i < nodes->end; i++)
        if (slc_page_nodes_find(nodes, nodes->at[i].page) == i)
            visit(user, nodes->at[i].page);
}
