/** Release of pages, which become absent. */
#ifndef SLC_DEMAND_PAGE_RELEASE_H
#define SLC_DEMAND_PAGE_RELEASE_H

#include "demand/page_state.h"

/** Makes a loading or resident page in no list absent. Call slc_residency_note afterwards.
 * `evicted`: the page can be restored. */
void slc_residency_release(struct slc_demand_residency *r, uint32_t index, bool evicted);

/** Makes an absent page in no list restorable. */
void slc_residency_become_restorable(struct slc_demand_residency *r, uint32_t index,
                                     uint32_t place);

#endif /* SLC_DEMAND_PAGE_RELEASE_H */
