/**
 * Pyramid: makes all levels of an image from the rows of level 0. Memory per level: the rows within
 * the filter's reach.
 *
 * Rows are [width][4] floats of linear light, premultiplied, without NaN and infinities. The input
 * of each level is the finer level at full precision, not the stored texels.
 */
#ifndef SLC_BAKE_PYRAMID_H
#define SLC_BAKE_PYRAMID_H

#include "bake/columns.h"

#define SLC_MAX_LEVELS 21 /* for 2^20 texels */

/** Makes one level from the rows of the next finer level ("above"). */
struct slc_halving {
    struct slc_axis rows;
    struct slc_columns columns;
    uint32_t first;          ///< first row above to arrive
    uint32_t first_below;    ///< first row below to be made
    uint32_t received, made; ///< rows so far
    uint32_t head_count;     ///< first rows, kept for rows that wrap around
    uint32_t ring_count;     ///< last rows, kept
    float *kept;             ///< [head_count + ring_count][rows' width below][4]
    float *row;              ///< [width below][4]
    struct slc_taps taps;    ///< for the next row
};

struct slc_pyramid_info {
    uint32_t width, height; ///< 1 to 2^20
    SluiceBakeFilter filter;
    SluiceBakeWrap wrap_x, wrap_y;
    void *user;
    /**
     * Receives row `y` of `level` > 0. Rows of a level come in order from row 0 on. If the filter
     * reaches around the edge (wider than a box, repeated in y), a later row comes first, and the
     * rows before it follow after the last row.
     */
    SluiceResult (*row)(void *user, uint32_t level, uint32_t y, const float *rgba);
    bool may_overflow; ///< rows hold numbers near FLT_MAX; sums of floats may overflow
};

struct slc_pyramid {
    struct slc_pyramid_info info;
    uint32_t level_count;
    struct slc_halving halvings[SLC_MAX_LEVELS]; ///< [l] makes level l + 1
};

/** Allocates the rows. Errors: OUT_OF_HOST_MEMORY; call slc_pyramid_finish then, too. */
SluiceResult slc_pyramid_init(struct slc_pyramid *pyramid, const SluiceAllocationCallbacks *cb,
                              const struct slc_pyramid_info *info);
void slc_pyramid_finish(struct slc_pyramid *pyramid, const SluiceAllocationCallbacks *cb);

/** Takes the next row of level 0, from row 0 on. Errors: the callback's result. */
SluiceResult slc_pyramid_push(struct slc_pyramid *pyramid, const float *rgba);

/** Starts again with row 0. */
void slc_pyramid_rewind(struct slc_pyramid *pyramid);

/** Returns the bytes that slc_pyramid_init allocates. */
uint64_t slc_pyramid_memory(const struct slc_pyramid_info *info);

#endif /* SLC_BAKE_PYRAMID_H */
