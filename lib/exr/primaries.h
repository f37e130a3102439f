/** Conversion from a file's primaries to Rec. ITU-R BT.709. */
#ifndef SLC_EXR_PRIMARIES_H
#define SLC_EXR_PRIMARIES_H

#include <stdbool.h>
#include <stdint.h>

/** CIE 1931 chromaticities, x and y. */
struct slc_chromaticities {
    double red[2], green[2], blue[2], white[2];
};

extern const struct slc_chromaticities slc_rec709;

/**
 * Finds the matrix from linear RGB of `from` to linear RGB of Rec. 709, white at 1. Bradford's
 * adaptation maps the chromaticities of `neutral` to R = G = B. `neutral` NULL: the white of
 * `from`, or D65 (no adaptation) if `from` is CIE XYZ. False if `from` are not valid primaries.
 */
bool slc_primaries_to_rec709(const struct slc_chromaticities *from, const double neutral[2],
                             double matrix[3][3]);

/** Tells whether the matrix changes every half by at most half a step. */
bool slc_matrix_is_identity(double matrix[3][3]);

/**
 * Multiplies `count` colors [count][3] in place. Colors with a NaN or an infinity stay as they are:
 * an infinity would spread to the other channels, with either sign. Sums saturate at +-FLT_MAX.
 */
void slc_convert_colors(double matrix[3][3], float *colors, uint32_t count);

#endif /* SLC_EXR_PRIMARIES_H */
