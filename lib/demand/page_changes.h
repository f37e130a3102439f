/** Changes of pages that the page table does not show yet. */
#ifndef SLC_DEMAND_PAGE_CHANGES_H
#define SLC_DEMAND_PAGE_CHANGES_H

#include "demand/page_state.h"

/** Lists a changed node for the page table, and drops a node that is not needed any more. Call it
 *  after every change of a node. */
void slc_residency_note(struct slc_demand_residency *r, uint32_t index);
/** Reserves room for the values of all pages that hold one, and one more. False without memory. */
bool slc_residency_reserve_evicted(struct slc_demand_residency *r);

#endif /* SLC_DEMAND_PAGE_CHANGES_H */
