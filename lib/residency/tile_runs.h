/** Moves of many entries between MAPPED and STANDBY. */
#ifndef SLC_RESIDENCY_TILE_RUNS_H
#define SLC_RESIDENCY_TILE_RUNS_H

#include "residency/machine.h"

/** Regular tiles of one level on their way between MAPPED and STANDBY. */
struct slc_run {
    uint32_t first, last, next; ///< nodes; `next` followed the last one
    uint32_t count, level;
    bool wanted;
};
/** The tile's move joins the run or begins the next one; false, and nothing, if it is another. */
bool slc_run_add(struct slc_machine *r, struct slc_run *run, uint32_t node, uint32_t level,
                 bool wanted);
/** The moves of the run are made. */
void slc_run_end(struct slc_machine *r, struct slc_run *run);

#endif /* SLC_RESIDENCY_TILE_RUNS_H */
