/**
 * All levels of an image from its rows, each level with no more rows in memory than the filter
 * reaches over.
 *
 * Rows are [width][4] floats in which filtering is linear: light, premultiplied, no NaN, no
 * infinities. Each level is made from the one above at full precision, not from what is stored.
 */
#ifndef SLC_BAKE_PYRAMID_H
#define SLC_BAKE_PYRAMID_H

#include "bake/columns.h"

#define SLC_MAX_LEVELS 21 /* of 2^20 texels */

/** Makes one level from the rows of the one above it. */
struct slc_halving {
    struct slc_axis rows;
    struct slc_columns columns;
    uint32_t first;          ///< row above that comes first
    uint32_t first_below;    ///< row below that is made first
    uint32_t received, made; ///< rows so far
    uint32_t head_count;     ///< rows kept from the first on, for those that wrap around to them
    uint32_t ring_count;     ///< rows kept of the last ones
    float *kept;             ///< [head_count + ring_count][rows' width below][4]
    float *row;              ///< [width below][4]
    struct slc_taps taps;    ///< of the row that is made next
};

struct slc_pyramid_info {
    uint32_t width, height; ///< 1 to 2^20
    SluiceBakeFilter filter;
    SluiceBakeWrap wrap_x, wrap_y;
    void *user;
    /**
     * Row `y` of `level`, below level 0. Rows of a level come in order, beginning with row 0, or
     * where the filter reaches around the edge (wider than a box, repeated in y) with a later one,
     * those before it following after the last.
     */
    SluiceResult (*row)(void *user, uint32_t level, uint32_t y, const float *rgba);
    bool may_overflow; ///< rows hold numbers near FLT_MAX: sums of floats may leave the range
};

struct slc_pyramid {
    struct slc_pyramid_info info;
    uint32_t level_count;
    struct slc_halving halvings[SLC_MAX_LEVELS]; ///< [l] makes level l + 1
};

/** Errors: OUT_OF_HOST_MEMORY; finish it then, too. */
SluiceResult slc_pyramid_init(struct slc_pyramid *pyramid, const SluiceAllocationCallbacks *cb,
                              const struct slc_pyramid_info *info);
void slc_pyramid_finish(struct slc_pyramid *pyramid, const SluiceAllocationCallbacks *cb);

/** The next row of level 0, from row 0 on. Errors: what the callback says. */
SluiceResult slc_pyramid_push(struct slc_pyramid *pyramid, const float *rgba);

/** Starts again with row 0. */
void slc_pyramid_rewind(struct slc_pyramid *pyramid);

/** Bytes that slc_pyramid_init allocates. */
uint64_t slc_pyramid_memory(const struct slc_pyramid_info *info);

#endif /* SLC_BAKE_PYRAMID_H */
