/** Decisions after a launch: bias and refusals. */
#ifndef SLC_DEMAND_PAGE_SETTLE_H
#define SLC_DEMAND_PAGE_SETTLE_H

#include "demand/page_state.h"

/** True if a page of the class without a place will get none by a coarser bias. */
bool slc_residency_is_hopeless(const struct slc_demand_residency *r, uint32_t class_index);

#endif /* SLC_DEMAND_PAGE_SETTLE_H */
