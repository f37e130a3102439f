/** Pages that become absent. */
#ifndef SLC_DEMAND_PAGE_RELEASE_H
#define SLC_DEMAND_PAGE_RELEASE_H

#include "demand/page_state.h"

/** From loading or resident, and in no list, to absent, which is still to be noted. Evicted: it may
 *  be retaken. */
void slc_residency_release(struct slc_demand_residency *r, uint32_t index, bool evicted);

/** An absent page in no list may be retaken. */
void slc_residency_become_restorable(struct slc_demand_residency *r, uint32_t index,
                                     uint32_t place);

#endif /* SLC_DEMAND_PAGE_RELEASE_H */
