/** Filters one row of RGBA floats to the width of the level below. */
#ifndef SLC_BAKE_COLUMNS_H
#define SLC_BAKE_COLUMNS_H

#include "bake/filter.h"

struct slc_columns {
    struct slc_axis axis;
    uint32_t tap_count;
    uint32_t distinct; ///< texels with different weights; 1: all texels have equal weights
    float *weights;    ///< [distinct][tap_count]
    float *padded;     ///< the row with SLC_MAX_REACH texels on either side; NULL for box filters
};

/** Allocates weights and rows. Errors: OUT_OF_HOST_MEMORY; finish it then, too. */
SluiceResult slc_columns_init(struct slc_columns *columns, const SluiceAllocationCallbacks *cb,
                              const struct slc_axis *axis);
void slc_columns_finish(struct slc_columns *columns, const SluiceAllocationCallbacks *cb);

/** Filters a row. `row`: [axis.size][4], `below`: [axis.below][4]; they must not overlap. */
void slc_columns_apply(struct slc_columns *columns, const float *row, float *below);

/** Like slc_columns_apply, but sums in double and saturates at +-FLT_MAX. Slow. */
void slc_columns_apply_wide(struct slc_columns *columns, const float *row, float *below);

/** True if all of `count` texels are finite. */
bool slc_row_is_finite(const float *row, uint32_t count);

/** sum[i] = weight * row[i] (set), or += (add), for `count` texels of four floats. */
void slc_row_set(const float *row, float weight, float *sum, uint32_t count);
void slc_row_add(const float *row, float weight, float *sum, uint32_t count);

/** Returns the bytes that slc_columns_init allocates. */
uint64_t slc_columns_memory(const struct slc_axis *axis);

#endif /* SLC_BAKE_COLUMNS_H */
