/** What the page table does not show yet. */
#ifndef SLC_DEMAND_PAGE_CHANGES_H
#define SLC_DEMAND_PAGE_CHANGES_H

#include "demand/page_state.h"

/** After every change of a node: lists what the page table does not show yet, and drops a node that
 *  is of no use any more. */
void slc_residency_note(struct slc_demand_residency *r, uint32_t index);
/** Room for the values of all pages that hold one, and of one more. False without memory. */
bool slc_residency_reserve_evicted(struct slc_demand_residency *r);

#endif /* SLC_DEMAND_PAGE_CHANGES_H */
