/** What a recorder sees of a page residency, and what a player needs to make an equal one. */
#ifndef SLC_DEMAND_PAGE_OBSERVER_H
#define SLC_DEMAND_PAGE_OBSERVER_H

#include "demand/page_calls.h"

/** A zeroed observer switches off. One at a time. */
void slc_residency_set_observer(struct slc_demand_residency *residency,
                                struct slc_page_observer observer);
struct slc_page_observer slc_residency_observer(const struct slc_demand_residency *residency);
/** Whether a page was requested, or a launch prepared or begun. */
bool slc_residency_is_used(const struct slc_demand_residency *residency);
/** What an equal residency is made of; `cb` is NULL. */
void slc_residency_get_info(const struct slc_demand_residency *residency,
                            struct slc_page_residency_create_info *info);
/** What slc_residency_set_class was given last. */
uint64_t slc_residency_get_class(const struct slc_demand_residency *residency, uint32_t class_index,
                                 bool *has_memory);
/** True if the class holds no page, and no evicted page could be restored. */
bool slc_residency_class_is_empty(const struct slc_demand_residency *residency,
                                  uint32_t class_index);
/** At least as many as slc_residency_take_changes or slc_residency_take_evicted would return. */
uint32_t slc_residency_most_entries(const struct slc_demand_residency *residency);
/** Whether slc_residency_loaded or slc_residency_failed is to come. */
bool slc_residency_is_loading(const struct slc_demand_residency *residency, uint32_t page);

#endif /* SLC_DEMAND_PAGE_OBSERVER_H */
