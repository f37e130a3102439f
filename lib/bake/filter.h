/**
 * Filter weights of one texel along one axis, over the level above it: polyphase weights for any
 * size.
 *
 * The level below n texels has max(1, n / 2) texels, rounded down. Both levels cover the same area.
 * Each texel below covers n / max(1, n / 2) texels, between 2 and 3. The box filter is their mean;
 * wider filters are scaled accordingly. An axis of one texel is copied.
 */
#ifndef SLC_BAKE_FILTER_H
#define SLC_BAKE_FILTER_H

#include <sluice/bake.h>

/** Kaiser's support is 3 texels of the level below on either side, each up to 3 above. */
#define SLC_MAX_TAPS 20
/** Rows or columns beyond the edge that a tap can reach. */
#define SLC_MAX_REACH 12

struct slc_axis {
    uint32_t size, below; ///< texels of the level above, and of the level that is made
    SluiceBakeFilter filter;
    SluiceBakeWrap wrap;
};

/** Weights of `count` texels from `first` on, which may be beyond either edge. Their sum is 1. */
struct slc_taps {
    int32_t first;
    uint32_t count;
    float weights[SLC_MAX_TAPS];
};

struct slc_axis slc_axis_make(uint32_t size, SluiceBakeFilter filter, SluiceBakeWrap wrap);

/** Computes the taps of texel `i` of the level below. */
void slc_axis_taps(const struct slc_axis *axis, uint32_t i, struct slc_taps *taps);

/** Returns only the first texel of the taps of `i`. */
int32_t slc_axis_first(const struct slc_axis *axis, uint32_t i);

/** Returns the most taps of any texel. */
uint32_t slc_axis_max_taps(const struct slc_axis *axis);

/** Returns the texel for `index`, which may be beyond the edges by any number of sizes. */
uint32_t slc_wrap_index(SluiceBakeWrap wrap, int32_t index, uint32_t size);

#endif /* SLC_BAKE_FILTER_H */
