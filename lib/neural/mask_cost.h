/** Costs of texels while masks are repaired, and the texels that a code reaches. */
#ifndef SLC_NEURAL_MASK_COST_H
#define SLC_NEURAL_MASK_COST_H

#include "neural/fast_network.h"

/** Neighbors of a place: texels of a mip that use a column or row of a grid. Where the grid wraps,
 *  they are two runs. */
struct slc_mask_run {
    uint32_t first, count;
};

/** A texel as it decodes now. */
struct slc_mask_texel {
    float squares; ///< squared errors of its channels, weighted
    float excess;  ///< how far its masks are from 0 and 1 where they should be exactly that
};

/** Mips that share two grids. */
struct slc_mask_group {
    uint32_t first_mip, mip_count;
    uint32_t grid_size[2][2]; ///< of both grids: x, y
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
    double penalty; ///< of a texel that is not exact
};

/** A code of the group's grid `grid`. */
struct slc_mask_code {
    uint32_t grid, x, y, feature;
};

/** Decodes all mips. Errors: of sluiceDecodeNeuralTexels, logged; OUT_OF_HOST_MEMORY. */
SluiceResult slc_mask_init(struct slc_mask_repair *repair, const SluiceNeuralMaskInfo *info);
void slc_mask_finish(struct slc_mask_repair *repair);

/** Finds the texels that the codes of the mips' grids reach. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_mask_select(struct slc_mask_repair *repair, uint32_t first_mip);

uint32_t slc_mask_get_code(const struct slc_mask_repair *repair, const struct slc_mask_code *code);
void slc_mask_set_code(const struct slc_mask_repair *repair, const struct slc_mask_code *code,
                       uint32_t value);

/** How much more all texels that the code reaches cost now than when they were counted; anything
 *  above `limit` if that is exceeded. */
double slc_mask_compare(const struct slc_mask_repair *repair, const struct slc_mask_code *code,
                        double limit);

/** Counts the texels again that the code reaches. */
void slc_mask_count(const struct slc_mask_repair *repair, const struct slc_mask_code *code);

/** Counts all texels of the group again. Errors: none that slc_mask_init did not find. */
SluiceResult slc_mask_count_group(struct slc_mask_repair *repair);

/** A texel as it would decode now, without counting it. */
struct slc_mask_texel slc_mask_decode_texel(const struct slc_mask_repair *repair, uint32_t mip,
                                            uint32_t x, uint32_t y);

/** A mip and its slices, as decoders take them. */
struct slc_neural_mip_view slc_mask_view(const struct slc_mask_repair *repair, uint32_t mip);

#endif /* SLC_NEURAL_MASK_COST_H */
