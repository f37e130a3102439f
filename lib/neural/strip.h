/**
 * Decoder of strips: SLC_STRIP_LANES columns of a mip, row by row, one texel per lane. The sums of
 * a texel have the same order as in the scalar decoder, so results have the same bits. Built for
 * vectors of 16 bytes, and for AVX2.
 */
#ifndef SLC_NEURAL_STRIP_H
#define SLC_NEURAL_STRIP_H

#include "neural/fast_network.h"

#ifndef SLC_STRIP_LANES
#define SLC_STRIP_LANES 4
#endif

/* Comparisons of lanes yield all bits set or 0. */
typedef float slc_floats __attribute__((vector_size(4 * SLC_STRIP_LANES)));
typedef int32_t slc_ints __attribute__((vector_size(4 * SLC_STRIP_LANES)));
typedef uint32_t slc_words __attribute__((vector_size(4 * SLC_STRIP_LANES)));

/** Strip: values shared by all texels of a column, per lane. */
struct slc_neural_strip {
    const struct slc_neural_mip_view *view;
    uint32_t x[SLC_STRIP_LANES];             ///< columns; the last one is repeated
    uint32_t columns[2][2][SLC_STRIP_LANES]; ///< per slice: columns left and right of the texel
    slc_words fractions[2];                  ///< per slice: 256 - fraction, and fraction << 16
    float waves[6][SLC_STRIP_LANES];
    slc_words wave_codes[6]; ///< inputs of schema 3
};

void slc_strip_init(struct slc_neural_strip *strip, const struct slc_neural_mip_view *view,
                    uint32_t x, uint32_t count);

/** Computes the inputs of a row: even inputs in low halves of words, odd ones in high halves. */
void slc_strip_int8_inputs(const struct slc_neural_strip *strip, uint32_t y, slc_words *pairs);
/** Computes the inputs of a row, rounded to half, then to E4M3. */
void slc_strip_fp8_inputs(const struct slc_neural_strip *strip, uint32_t y, slc_floats *values);

/** Runs the network; `outputs` has 16 elements. Changes the inputs. */
void slc_strip_run_int8(const struct slc_neural_fast *fast, slc_words *pairs, slc_floats *outputs);
void slc_strip_run_fp8(const struct slc_neural_fast *fast, slc_floats *values, slc_floats *outputs);

#endif /* SLC_NEURAL_STRIP_H */
