/** Unwanted resident tiles, the one unwanted longest first. */
#ifndef SLC_RESIDENCY_STANDBY_H
#define SLC_RESIDENCY_STANDBY_H

#include "residency/machine.h"

/** Evicts the oldest ones until `keep` are left: lists them for unmapping. */
void slc_evict_standby(struct slc_machine *r, uint32_t keep);

#endif /* SLC_RESIDENCY_STANDBY_H */
