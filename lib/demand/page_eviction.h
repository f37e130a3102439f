/** Eviction of pages. */
#ifndef SLC_DEMAND_PAGE_EVICTION_H
#define SLC_DEMAND_PAGE_EVICTION_H

#include "demand/page_state.h"

/** Evicts one page of an LRU list, or of all lists of the class (SLC_NO_LRU). Returns false if all
 *  pages are in use. */
bool slc_residency_evict(struct slc_demand_residency *r, uint32_t class_index, uint32_t lru);
/** Evicts until the class is within its limit, or no page can be evicted. */
void slc_residency_trim(struct slc_demand_residency *r, uint32_t class_index);

#endif /* SLC_DEMAND_PAGE_EVICTION_H */
