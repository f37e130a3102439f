/** Modes 1, 4, 5 and 6 of BC7 for SLC_LANES blocks at a time. */
#ifndef SLC_BAKE_BC7_MODES_H
#define SLC_BAKE_BC7_MODES_H

#include "bake/bc7_fit.h"

struct slc_bc7_texels {
    slc_floats channels[4][16]; ///< 0 to 255
    slc_ints is_opaque;         ///< -1: every alpha is 255
    slc_ints has_black;         ///< -1: a texel is opaque black
};

/** A block before it is packed into bits. */
struct slc_bc7_block {
    float error; ///< sum of squares over texels and channels
    uint8_t mode, partition, rotation, swaps_indices;
    uint8_t ends[2][2][4];  ///< [region][end]; with p bits
    uint8_t indices[2][16]; ///< [0]: colors, or all channels; [1]: alpha, in modes 4 and 5
};

/** Tries mode 6 and replaces each block that it encodes with less error. */
void slc_bc7_try_mode_6(const struct slc_bc7_texels *texels, int rounds,
                        struct slc_bc7_block *blocks[SLC_LANES]);
/**
 * Tries mode 1 on opaque blocks, and replaces those that it encodes with less error. Ranks the
 * first `partitions` and fits the best `tries` of them.
 */
void slc_bc7_try_mode_1(const struct slc_bc7_texels *texels, int rounds, int partitions, int tries,
                        struct slc_bc7_block *blocks[SLC_LANES]);
/** Tries mode 4, as above. `rotation` 1 to 3: R, G or B in place of alpha. */
void slc_bc7_try_mode_4(const struct slc_bc7_texels *texels, int rounds, int rotation,
                        struct slc_bc7_block *blocks[SLC_LANES]);
/** Tries mode 5 like mode 4. */
void slc_bc7_try_mode_5(const struct slc_bc7_texels *texels, int rounds, int rotation,
                        struct slc_bc7_block *blocks[SLC_LANES]);

#endif /* SLC_BAKE_BC7_MODES_H */
