/** Which resident pages may be evicted, in the order of their last use (LRU). */
#ifndef SLC_DEMAND_PAGE_LRU_H
#define SLC_DEMAND_PAGE_LRU_H

#include "demand/page_state.h"

/** The LRU list of that class and kind; SLC_NO_LRU without memory. */
uint32_t slc_residency_lru(struct slc_demand_residency *r, uint32_t class_index, uint32_t kind);
/** Puts a page into its LRU list: resident, not pinned, in no list, last used by launch
 *  `last_use`. */
void slc_residency_enter_lru(struct slc_demand_residency *r, uint32_t index, uint64_t last_use);
/** Takes a node out of its home list, if any. */
void slc_residency_leave_home(struct slc_demand_residency *r, uint32_t index);

#endif /* SLC_DEMAND_PAGE_LRU_H */
