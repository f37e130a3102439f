/** Difficult samples: extreme sizes, coordinates, derivatives and samplers. */
#ifndef TESTS_DEVICE_DEMAND_SAMPLES_H
#define TESTS_DEVICE_DEMAND_SAMPLES_H

#include "device/demand_scene.h"

/** Returns a number from 0 to 1, excluding 1. */
double demand_random(void);

/** Makes a texture with any address modes and filters; sometimes with anisotropy and bias. */
struct demand_texture demand_random_texture(uint32_t width, uint32_t height);

/** Makes a coordinate from 0 over texel and tile borders to 1e6. `wild`: also NaN and
 * infinities. */
float demand_random_coordinate(uint32_t size, bool wild);

/** Gives one texture in three a bicubic filter, one a smart bicubic one. */
void demand_randomize_filter(struct demand_texture *texture);

/** Makes an input of any kind that samples, with LODs from -10 to 40. */
struct DemandInput demand_random_input(uint32_t index, const struct demand_texture *texture,
                                       bool wild);

#endif /* TESTS_DEVICE_DEMAND_SAMPLES_H */
