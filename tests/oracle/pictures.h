/** Pictures in memory, as libvips reads them. */
#ifndef TESTS_ORACLE_PICTURES_H
#define TESTS_ORACLE_PICTURES_H

#include "oracle/vec.h"

#include <sluice/pbrt.h>

#include <stdbool.h>

/** Row 0 on top. */
struct oracle_picture {
    uint32_t width, height, bands;
    bool eight_bits;
    bool has_alpha;
    float *values; ///< owned; 0 to 1 for integers; as the file has them
};

/** Reads a picture. Reports errors on stderr. */
bool oracle_picture_read(struct oracle_picture *picture, const char *path);
void oracle_picture_finish(struct oracle_picture *picture);

/** Conversion of texels to numbers. */
struct oracle_lookup {
    SluicePbrtWrap wrap;
    SluicePbrtEncoding encoding;
    double gamma;
    bool nearest;
};

/**
 * Samples a picture bilinearly at (u, v); (0, 0) is its upper left corner. Texels are decoded
 * first. Grey becomes a color. Returns alpha, or 1 if the picture has none, in *alpha.
 */
struct vec oracle_picture_sample(const struct oracle_picture *picture,
                                 const struct oracle_lookup *lookup, double u, double v,
                                 double *alpha);

#endif /* TESTS_ORACLE_PICTURES_H */
