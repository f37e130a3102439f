/**
 * What one texel takes from the level above it along one axis: polyphase weights for any size.
 *
 * A level of n texels has max(1, n / 2) below it, rounded down, and both cover the same area. Each
 * texel below covers n / max(1, n / 2) texels, between 2 and 3; the box filter is the mean of just
 * that, and wider filters are scaled to it. An axis of one texel is passed on as it is.
 */
#ifndef SLC_BAKE_FILTER_H
#define SLC_BAKE_FILTER_H

#include <sluice/bake.h>

/** Kaiser's support is 3 texels of the level below on either side, each up to 3 above. */
#define SLC_MAX_TAPS 20
/** Rows or columns beyond the edge that a tap can reach. */
#define SLC_MAX_REACH 12

struct slc_axis {
    uint32_t size, below; ///< texels of the level above and of the one that is made
    SluiceBakeFilter filter;
    SluiceBakeWrap wrap;
};

/** `count` texels from `first` on, which may lie beyond either edge; the weights' sum is 1. */
struct slc_taps {
    int32_t first;
    uint32_t count;
    float weights[SLC_MAX_TAPS];
};

struct slc_axis slc_axis_make(uint32_t size, SluiceBakeFilter filter, SluiceBakeWrap wrap);

/** Of texel `i` of the level below. */
void slc_axis_taps(const struct slc_axis *axis, uint32_t i, struct slc_taps *taps);

/** The first texel of `i`'s taps alone. */
int32_t slc_axis_first(const struct slc_axis *axis, uint32_t i);

/** No texel has more taps than this. */
uint32_t slc_axis_max_taps(const struct slc_axis *axis);

/** The texel that stands at `index`, which may be beyond the edges by any number of sizes. */
uint32_t slc_wrap_index(SluiceBakeWrap wrap, int32_t index, uint32_t size);

#endif /* SLC_BAKE_FILTER_H */
