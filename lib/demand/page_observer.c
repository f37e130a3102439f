#include "demand/page_observer.h"

#include "base/checked.h"
#include "demand/page_state.h"

#include <assert.h>

void slc_residency_set_observer(struct slc_demand_residency *residency,
                                struct slc_page_observer observer)
{
    residency->observer = observer;
}

struct slc_page_observer slc_residency_observer(const struct slc_demand_residency *residency)
{
    return residency->observer;
}

void slc_tell_use(const struct slc_demand_residency *r, uint32_t page)
{
    SLC_TELL_PAGES(r, .kind = SLC_PAGE_CALL_USE, .page = page);
}

bool slc_residency_is_used(const struct slc_demand_residency *residency)
{
    return residency->used;
}

void slc_residency_get_info(const struct slc_demand_residency *residency,
                            struct slc_page_residency_create_info *info)
{
    *info = (struct slc_page_residency_create_info){.class_count = residency->class_count,
                                                    .no_eviction = residency->no_eviction,
                                                    .no_lod_bias = residency->no_lod_bias};
}

uint64_t slc_residency_get_class(const struct slc_demand_residency *residency, uint32_t class_index,
                                 bool *has_memory)
{
    assert(class_index < residency->class_count);
    *has_memory = residency->classes[class_index].has_memory;
    return residency->classes[class_index].limit;
}

bool slc_residency_class_is_empty(const struct slc_demand_residency *residency,
                                  uint32_t class_index)
{
    assert(class_index < residency->class_count);
    const struct slc_page_class *c = &residency->classes[class_index];
    return c->held == 0 && c->restorable.count == 0;
}

uint32_t slc_residency_most_entries(const struct slc_demand_residency *residency)
{
    return slc_max_u32(residency->nodes.count, residency->evicted_count);
}

bool slc_residency_is_loading(const struct slc_demand_residency *residency, uint32_t page)
{
    uint32_t index = slc_page_nodes_find(&residency->nodes, page);
    return index != SLC_NO_NODE && residency->nodes.at[index].state == SLC_PAGE_LOADING;
}
