/**
 * Decodes strips: SLC_STRIP_LANES columns of a mip, texel by texel of a column. One texel per lane,
 * so that sums of each texel have the order that they have one by one: the bits are the same. Built
 * for vectors of 16 bytes, and for AVX2.
 */
#ifndef SLC_NEURAL_STRIP_H
#define SLC_NEURAL_STRIP_H

#include "neural/fast_network.h"

#ifndef SLC_STRIP_LANES
#define SLC_STRIP_LANES 4
#endif

/* Comparisons give all bits. */
typedef float slc_floats __attribute__((vector_size(4 * SLC_STRIP_LANES)));
typedef int32_t slc_ints __attribute__((vector_size(4 * SLC_STRIP_LANES)));
typedef uint32_t slc_words __attribute__((vector_size(4 * SLC_STRIP_LANES)));

/** Values that all texels of a column share, per lane. */
struct slc_neural_strip {
    const struct slc_neural_mip_view *view;
    uint32_t x[SLC_STRIP_LANES];             ///< columns; the last one is repeated
    uint32_t columns[2][2][SLC_STRIP_LANES]; ///< of both slices: left and right of the texel
    slc_words fractions[2];                  ///< of both: 256 - fraction, and fraction << 16
    float waves[6][SLC_STRIP_LANES];
    slc_words wave_codes[6]; ///< inputs of schema 3
};

void slc_strip_init(struct slc_neural_strip *strip, const struct slc_neural_mip_view *view,
                    uint32_t x, uint32_t count);

/** Inputs of a row: the even one in the low half of a word, the odd one in the high half. */
void slc_strip_int8_inputs(const struct slc_neural_strip *strip, uint32_t y, slc_words *pairs);
/** Rounded to half, then to E4M3. */
void slc_strip_fp8_inputs(const struct slc_neural_strip *strip, uint32_t y, slc_floats *values);

/** Runs the network; `outputs` has 16 elements. Changes the inputs. */
void slc_strip_run_int8(const struct slc_neural_fast *fast, slc_words *pairs, slc_floats *outputs);
void slc_strip_run_fp8(const struct slc_neural_fast *fast, slc_floats *values, slc_floats *outputs);

#endif /* SLC_NEURAL_STRIP_H */
