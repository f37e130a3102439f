/** Decoder of texels on the host. With INT8 weights, results equal the shaders' bit by bit. */
#ifndef SLC_NEURAL_DECODER_H
#define SLC_NEURAL_DECODER_H

#include "neural/network.h"

#include <math.h>

enum { SLC_NEURAL_MAX_INPUTS = 96, SLC_NEURAL_MAX_NEURONS = 64 };

/** View of a mip, its two grids, and the slices' codes. */
struct slc_neural_mip_view {
    const SluiceNeuralConstants *constants;
    uint32_t mip, width, height;
    SluiceNeuralSlice slices[2];
    const uint8_t *codes[2]; ///< codes of both slices
};

/** Four grid texels around a place in a grid, and their weights. */
struct slc_neural_corners {
    uint32_t texels[4];  ///< numbers in the slice: (x0, y0), (x1, y0), (x0, y1), (x1, y1)
    uint32_t weights[4]; ///< in units of 1 / 65536
};

/** Finds the two columns (axis 0) or rows (axis 1) of the slice `g` around the texel's, and 256
 *  times the fraction. */
void slc_neural_find_axis(const struct slc_neural_mip_view *view, uint32_t g, uint32_t axis,
                          uint32_t texel, uint32_t corners[2], uint32_t *fraction);

/** Finds the corners of a texel in the slice `g` of a mip. */
void slc_neural_find_corners(const struct slc_neural_mip_view *view, uint32_t g, uint32_t x,
                             uint32_t y, struct slc_neural_corners *corners);

/** Returns a code of a slice. */
static inline uint32_t slc_neural_code(const uint8_t *codes, uint32_t features, uint32_t bits,
                                       uint32_t texel, uint32_t feature)
{
    uint32_t bit = (texel * features + feature) * bits; /* slices have less than 2^32 */
    return (uint32_t)codes[bit / 8] >> bit % 8 & ((1u << bits) - 1);
}

/** Computes waves 0, 2 .. 10 of a column, or 1, 3 .. 11 of a row: -1 to 1. */
static inline void slc_neural_axis_waves(const struct slc_neural_mip_view *view, uint32_t texel,
                                         float waves[6])
{
    const float p = (float)texel * view->constants->mips[view->mip].positionScale;
    const bool is_one = view->constants->schema == 1;
    for (int k = 0; k < 6; k++) {
        float t = is_one ? p * (0.125f * (float)(1 << k / 2)) : p * (float)(1 << k / 2);
        if (k % 2)
            t += 0.25f;
        if (is_one)
            waves[k] = fabsf(4 * (t - floorf(t)) - 2) - 1;
        else
            waves[k] = 2 * (t - floorf(t)) - 1;
    }
}

/** Computes the network's inputs for a texel. `inputs` has constants->inputCount elements. */
void slc_neural_int8_inputs(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                            int8_t *inputs);
void slc_neural_fp8_inputs(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                           float *inputs);

/** Runs the network. `outputs` has 16 elements. Inputs of FP8 are rounded to half, then to E4M3. */
void slc_neural_run_int8(const struct slc_neural_shape *shape, const struct slc_neural_blob *at,
                         const uint8_t *weights, const int8_t *inputs, float *outputs);
void slc_neural_run_fp8(const struct slc_neural_shape *shape, const struct slc_neural_blob *at,
                        const uint8_t *weights, const float *inputs, float *outputs);

struct slc_neural_fast;

/** A rectangle to decode. */
struct slc_neural_job {
    const struct slc_neural_mip_view *view;
    const struct slc_neural_shape *shape;
    SluiceNeuralWeightKind kind;
    const uint8_t *weights;
    const struct slc_neural_fast *fast; ///< made from the weights; NULL: each strip makes its own
    uint32_t x, y, width, height;
    uint32_t first_channel, channel_count;
    float *texels;
    uint64_t pitch; ///< floats from row to row
};

/** Decode function for 1, 4 or 8 texels at a time. All return the same bits. */
typedef void slc_neural_way(const struct slc_neural_job *job);
slc_neural_way slc_neural_decode_plainly, slc_neural_decode_strips, slc_neural_decode_strips_avx2;

/** Returns the fastest decode function for this processor. */
slc_neural_way *slc_neural_fastest_way(void);

/** Implements sluiceDecodeNeuralTexels with a given decode function. */
SluiceResult slc_neural_decode(const SluiceNeuralDecodeInfo *info, slc_neural_way *way);

/** Converts from E4M3: 4 bits of exponent, 3 of mantissa, no infinities. */
float slc_float_from_e4m3(uint8_t bits);
/** Converts to the nearest E4M3, ties to even, at most +-448. */
uint8_t slc_e4m3_from_float(float value);

#endif /* SLC_NEURAL_DECODER_H */
