/** Costs of texels during repair of masks, and the texels that depend on a code. */
#ifndef SLC_NEURAL_MASK_COST_H
#define SLC_NEURAL_MASK_COST_H

#include "neural/fast_network.h"

/** Run: adjacent texels of a mip that use a column or row of a grid. Two runs where the grid wraps.
 */
struct slc_mask_run {
    uint32_t first, count;
};

/** Errors of a decoded texel. */
struct slc_mask_texel {
    float squares; ///< squared errors of its channels, weighted
    float excess;  ///< distance of its masks from 0 and 1, where exactly 0 or 1 is required
};

/** Mips that share two grids. */
struct slc_mask_group {
    uint32_t first_mip, mip_count;
    uint32_t grid_size[2][2]; ///< size of both grids: x, y
};

struct slc_mask_repair {
    const SluiceNeuralMaskInfo *info;
    SluiceNeuralConstants constants;
    struct slc_neural_shape shape;
    struct slc_neural_fast *fast; ///< owned
    slc_neural_way *way;
    struct slc_mask_group group;
    struct slc_mask_run *runs; ///< owned: [mip of group][grid][axis][column or row][2]
    size_t run_count;
    struct slc_mask_texel *texels[SLUICE_NEURAL_MAX_MIPS]; ///< owned
    float *decoded;                                        ///< owned, decoded_count
    uint8_t *best_latents;                                 ///< owned, latentSize
    size_t decoded_count;
    double penalty; ///< cost of an inexact texel
};

/** Position of a code in grid `grid` of the group. */
struct slc_mask_code {
    uint32_t grid, x, y, feature;
};

/** Decodes all mips. Errors: sluiceDecodeNeuralTexels', logged; OUT_OF_HOST_MEMORY. */
SluiceResult slc_mask_init(struct slc_mask_repair *repair, const SluiceNeuralMaskInfo *info);
void slc_mask_finish(struct slc_mask_repair *repair);

/** Finds the texels that depend on each column and row of grids. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_mask_select(struct slc_mask_repair *repair, uint32_t first_mip);

uint32_t slc_mask_get_code(const struct slc_mask_repair *repair, const struct slc_mask_code *code);
void slc_mask_set_code(const struct slc_mask_repair *repair, const struct slc_mask_code *code,
                       uint32_t value);

/** Returns the increase in cost, since the last count, of all texels that depend on the code. Stops
 *  early with a value above `limit`. */
double slc_mask_compare(const struct slc_mask_repair *repair, const struct slc_mask_code *code,
                        double limit);

/** Counts the costs of the code's texels again. */
void slc_mask_count(const struct slc_mask_repair *repair, const struct slc_mask_code *code);

/** Counts all texels of the group again. Errors: as in slc_mask_init, which has ruled them out. */
SluiceResult slc_mask_count_group(struct slc_mask_repair *repair);

/** Decodes a texel and returns its errors, without counting. */
struct slc_mask_texel slc_mask_decode_texel(const struct slc_mask_repair *repair, uint32_t mip,
                                            uint32_t x, uint32_t y);

/** Returns the decoder's view of a mip and its slices. */
struct slc_neural_mip_view slc_mask_view(const struct slc_mask_repair *repair, uint32_t mip);

#endif /* SLC_NEURAL_MASK_COST_H */
