/** Changes of many tiles between MAPPED and STANDBY. */
#ifndef SLC_RESIDENCY_TILE_RUNS_H
#define SLC_RESIDENCY_TILE_RUNS_H

#include "residency/machine.h"

/** Regular tiles of one level that change between MAPPED and STANDBY. */
struct slc_run {
    uint32_t first, last, next; ///< nodes; `next`: node after the last one in the old list
    uint32_t count, level;
    bool wanted;
};
/** Adds a tile's change to the run, or begins the next run. False, with nothing done, for other
 * changes. */
bool slc_run_add(struct slc_machine *r, struct slc_run *run, uint32_t node, uint32_t level,
                 bool wanted);
/** Applies the changes of the run. */
void slc_run_end(struct slc_machine *r, struct slc_run *run);

#endif /* SLC_RESIDENCY_TILE_RUNS_H */
