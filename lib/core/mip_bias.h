/** A coarser level for all while more is wanted than there are slots. */
#ifndef SLC_CORE_MIP_BIAS_H
#define SLC_CORE_MIP_BIAS_H

#include "core/state.h"

/** The greatest bias, in sixteenths of a level. */
#define SLC_MAX_MIP_BIAS 320u
/** Values below the floor that can fail one after the other. */
#define SLC_MAX_BIAS_TRIALS 12u

/** How many tiles may be wanted: a multiple of the slots that there can be, as far as is known. */
uint64_t slc_slot_limit(const slc_manager *m);
/**
 * Once per hand-out: raises the bias if too much is wanted, lowers it if there is room. `limit` is
 * the slot limit before heaps were asked for.
 */
void slc_update_bias(slc_manager *m, uint64_t limit);
/** Writes what the global bias adds in each region. */
void slc_bias_map(const slc_manager *m, const struct slc_managed_texture *t, uint8_t *map);

#endif /* SLC_CORE_MIP_BIAS_H */
