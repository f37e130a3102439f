/**
 * Renames the decoder of strips for its second build, with eight lanes and AVX2. meson.build
 * includes this header before everything else. Texels have the same bits in both builds.
 */
#ifndef SLC_NEURAL_STRIP_AVX2_NAMES_H
#define SLC_NEURAL_STRIP_AVX2_NAMES_H

#define slc_strip_init slc_strip_init_avx2
#define slc_strip_int8_inputs slc_strip_int8_inputs_avx2
#define slc_strip_fp8_inputs slc_strip_fp8_inputs_avx2
#define slc_strip_run_int8 slc_strip_run_int8_avx2
#define slc_strip_run_fp8 slc_strip_run_fp8_avx2
#define slc_neural_decode_strips slc_neural_decode_strips_avx2

#endif /* SLC_NEURAL_STRIP_AVX2_NAMES_H */
