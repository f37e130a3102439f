/** FLIP computed the slow way, in double precision: two-dimensional kernels pixel by pixel. */
#ifndef TESTS_METRICS_FLIP_ORACLE_H
#define TESTS_METRICS_FLIP_ORACLE_H

#include <stdint.h>

/** RGBA8 pictures of up to 64x64 pixels; fills `errors`, [height][width]. */
void flip_oracle(const uint8_t *a, const uint8_t *b, int width, int height,
                 double pixels_per_degree, double *errors);

/** HyAB of blue and green to the power 0.7, with Hunt's adjustment. */
double flip_oracle_largest(void);

#endif /* TESTS_METRICS_FLIP_ORACLE_H */
