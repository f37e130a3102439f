/** Global mip bias: makes all requests coarser while more tiles are wanted than there are slots. */
#ifndef SLC_CORE_MIP_BIAS_H
#define SLC_CORE_MIP_BIAS_H

#include "core/state.h"

/** The greatest bias, in sixteenths of a level. */
#define SLC_MAX_MIP_BIAS 320u
/** Most consecutive failures of values below the floor that are counted. */
#define SLC_MAX_BIAS_TRIALS 12u

/** Returns how many tiles may be wanted: a multiple of the slots that can exist, as far as known.
 */
uint64_t slc_slot_limit(const slc_manager *m);
/**
 * Raises the bias if too many tiles are wanted, lowers it if there is room. Call it once per
 * hand-out. `limit` is the slot limit before new heaps were requested.
 */
void slc_update_bias(slc_manager *m, uint64_t limit);
/** Writes the levels that the global bias adds to each region. */
void slc_bias_map(const slc_manager *m, const struct slc_managed_texture *t, uint8_t *map);

#endif /* SLC_CORE_MIP_BIAS_H */
