/** LRU lists of resident pages that may be evicted. */
#ifndef SLC_DEMAND_PAGE_LRU_H
#define SLC_DEMAND_PAGE_LRU_H

#include "demand/page_state.h"

/** Finds or makes the LRU list of a class and kind. SLC_NO_LRU without memory. */
uint32_t slc_residency_lru(struct slc_demand_residency *r, uint32_t class_index, uint32_t kind);
/** Adds a page to its LRU list. The page must be resident, not pinned, and in no list. `last_use`:
 *  launch that used it last. */
void slc_residency_enter_lru(struct slc_demand_residency *r, uint32_t index, uint64_t last_use);
/** Removes a node from its home list, if it is in one. */
void slc_residency_leave_home(struct slc_demand_residency *r, uint32_t index);

#endif /* SLC_DEMAND_PAGE_LRU_H */
