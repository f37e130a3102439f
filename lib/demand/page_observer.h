/** Observer of a page residency for recorders, and queries with which players make an equal one. */
#ifndef SLC_DEMAND_PAGE_OBSERVER_H
#define SLC_DEMAND_PAGE_OBSERVER_H

#include "demand/page_calls.h"

/** Sets the only observer. A zeroed observer: none. */
void slc_residency_set_observer(struct slc_demand_residency *residency,
                                struct slc_page_observer observer);
struct slc_page_observer slc_residency_observer(const struct slc_demand_residency *residency);
/** True if a page was requested, or a launch prepared or begun. */
bool slc_residency_is_used(const struct slc_demand_residency *residency);
/** Gets the create-info of an equal residency; `cb` is NULL. */
void slc_residency_get_info(const struct slc_demand_residency *residency,
                            struct slc_page_residency_create_info *info);
/** Returns the limit that slc_residency_set_class was given last. */
uint64_t slc_residency_get_class(const struct slc_demand_residency *residency, uint32_t class_index,
                                 bool *has_memory);
/** True if the class holds no page, and no evicted page can be restored. */
bool slc_residency_class_is_empty(const struct slc_demand_residency *residency,
                                  uint32_t class_index);
/** Returns an upper bound of the entries of slc_residency_take_changes and _take_evicted. */
uint32_t slc_residency_most_entries(const struct slc_demand_residency *residency);
/** True if a call of slc_residency_loaded or slc_residency_failed is due for the page. */
bool slc_residency_is_loading(const struct slc_demand_residency *residency, uint32_t page);

#endif /* SLC_DEMAND_PAGE_OBSERVER_H */
