/** What a launch tells about the bias. */
#ifndef SLC_DEMAND_PAGE_SETTLE_H
#define SLC_DEMAND_PAGE_SETTLE_H

#include "demand/page_state.h"

/** A page of the class that has no place now will not get one while nothing changes. */
bool slc_residency_is_hopeless(const struct slc_demand_residency *r, uint32_t class_index);

#endif /* SLC_DEMAND_PAGE_SETTLE_H */
