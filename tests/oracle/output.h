/** Writes pictures, and compares them. */
#ifndef TESTS_ORACLE_OUTPUT_H
#define TESTS_ORACLE_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

/** Writes [height][width] RGBA floats, row 0 on top. Writes sRGB bytes if the name ends with .png,
 * else a PFM file of three floats. Reports errors on stderr. */
bool oracle_write(const char *path, const float *rgba, uint32_t width, uint32_t height);

struct oracle_difference {
    double flip;           ///< mean, with white at 1
    double mean_a, mean_b; ///< mean over all channels, unclamped
    double rms;            ///< root mean square of the difference, with values clamped to 1
    double equal;          ///< share of pixels whose channels all differ by less than 1/255
};

/** Compares with a PFM, EXR or PNG file of equal size. Reports errors on stderr. */
bool oracle_compare(const char *path, const float *rgba, uint32_t width, uint32_t height,
                    struct oracle_difference *difference);

#endif /* TESTS_ORACLE_OUTPUT_H */
