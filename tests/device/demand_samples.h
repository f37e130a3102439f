/** Samples that are hard: sizes, coordinates, derivatives and samplers at the ends of their ranges.
 */
#ifndef TESTS_DEVICE_DEMAND_SAMPLES_H
#define TESTS_DEVICE_DEMAND_SAMPLES_H

#include "device/demand_scene.h"

/** 0 to 1, 1 excluded. */
double demand_random(void);

/** Any address modes, filters, anisotropy and bias, now and then. */
struct demand_texture demand_random_texture(uint32_t width, uint32_t height);

/** Coordinates from 0 over texel and tile borders to 1e6; with `wild` NaN and infinities, too. */
float demand_random_coordinate(uint32_t size, bool wild);

/** Of any kind that samples; LODs from -10 to 40. */
/** Gives one texture in three a bicubic filter, one a smart bicubic one. */
void demand_randomize_filter(struct demand_texture *texture);

struct DemandInput demand_random_input(uint32_t index, const struct demand_texture *texture,
                                       bool wild);

#endif /* TESTS_DEVICE_DEMAND_SAMPLES_H */
