/** Pictures for tests of metrics: noise, and a drawing with edges, ramps and points. */
#ifndef TESTS_METRICS_PICTURES_H
#define TESTS_METRICS_PICTURES_H

#include <sluice/metrics.h>

/** The next of a series of numbers in [0, 1). */
double random_next(uint32_t *state);

/** Fills `count` bytes. */
void fill_random(uint8_t *bytes, size_t count, uint32_t seed);

/** Discs, stripes and ramps, [height][width][4]. */
void fill_drawing(uint8_t *pixels, uint32_t width, uint32_t height);

/** A copy with noise of +-amplitude on R, G and B, of one seed: larger amplitudes move all further.
 */
void add_noise(const uint8_t *pixels, uint8_t *out, size_t pixel_count, int amplitude);

/** Light in [0, 1] of an encoded value in [0, 1]. */
double light_of(double encoded);

/** Two tightly packed RGBA8 pictures. */
SluicePicturePair rgba8_pair(const void *a, const void *b, uint32_t width, uint32_t height);

#endif /* TESTS_METRICS_PICTURES_H */
