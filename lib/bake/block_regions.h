/** Ranks the partitions of SLC_LANES blocks by their colors. */
#ifndef SLC_BAKE_BLOCK_REGIONS_H
#define SLC_BAKE_BLOCK_REGIONS_H

#include "bake/block_lanes.h"

/** Writes the squared distances of texels from the two lines of each of the first `partitions`. */
void slc_estimate_regions(const slc_floats channels[3][16], int partitions, slc_floats *estimates);

/** Returns the partition with the least estimate, and sets that estimate to FLT_MAX. */
slc_ints slc_take_regions(slc_floats *estimates, int partitions);

#endif /* SLC_BAKE_BLOCK_REGIONS_H */
