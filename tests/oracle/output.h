/** Pictures in files, and how much two of them differ. */
#ifndef TESTS_ORACLE_OUTPUT_H
#define TESTS_ORACLE_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

/** Writes [height][width] RGBA floats, row 0 on top, as a PFM file of three floats, or as sRGB
 * bytes if the name ends with .png. Says on stderr why it failed. */
bool oracle_write(const char *path, const float *rgba, uint32_t width, uint32_t height);

struct oracle_difference {
    double flip;           ///< mean, with white at 1
    double mean_a, mean_b; ///< of all channels, unclamped
    double rms;            ///< of the difference of values that are clamped to 1
    double equal;          ///< share of pixels whose channels all differ by less than 1/255
};

/** Compares with a PFM, EXR or PNG file of the same size. Says on stderr why it failed. */
bool oracle_compare(const char *path, const float *rgba, uint32_t width, uint32_t height,
                    struct oracle_difference *difference);

#endif /* TESTS_ORACLE_OUTPUT_H */
