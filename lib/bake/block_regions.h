/** Which partitions suit the colors of SLC_LANES blocks. */
#ifndef SLC_BAKE_BLOCK_REGIONS_H
#define SLC_BAKE_BLOCK_REGIONS_H

#include "bake/block_lanes.h"

/** How far texels are from the two lines of each of the first `partitions`: sums of squares. */
void slc_estimate_regions(const slc_floats channels[3][16], int partitions, slc_floats *estimates);

/** The partition of the least estimate, which is then out of the way. */
slc_ints slc_take_regions(slc_floats *estimates, int partitions);

#endif /* SLC_BAKE_BLOCK_REGIONS_H */
