/**
 * Renames the encoders of BC6H and BC7 for their second build, with eight lanes and AVX2.
 * meson.build includes this header before everything else. Blocks have the same bytes in both
 * builds.
 */
#ifndef SLC_BAKE_AVX2_NAMES_H
#define SLC_BAKE_AVX2_NAMES_H

#define slc_bc7_try_mode_1 slc_bc7_try_mode_1_avx2
#define slc_bc7_try_mode_4 slc_bc7_try_mode_4_avx2
#define slc_bc7_try_mode_5 slc_bc7_try_mode_5_avx2
#define slc_bc7_try_mode_6 slc_bc7_try_mode_6_avx2
#define slc_estimate_regions slc_estimate_regions_avx2
#define slc_take_regions slc_take_regions_avx2
#define slc_encode_bc6h slc_encode_bc6h_avx2
#define slc_encode_bc7 slc_encode_bc7_avx2

#endif /* SLC_BAKE_AVX2_NAMES_H */
