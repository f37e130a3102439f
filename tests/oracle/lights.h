/** Direct light at points. */
#ifndef TESTS_ORACLE_LIGHTS_H
#define TESTS_ORACLE_LIGHTS_H

#include "oracle/rays.h"

/** An emitting triangle in world space. */
struct oracle_emitter {
    struct vec corner, side1, side2;
    struct vec outside; ///< unit normal
    double area, weight_before;
    uint32_t light;
};

struct oracle_lights {
    const struct oracle_scene *scene;
    struct oracle_values *values;
    struct oracle_emitter *emitters; ///< owned
    size_t emitter_count;
    double weight;         ///< sum over all emitters
    struct vec background; ///< light from all directions, in addition to infinite lights
};

bool oracle_lights_create(struct oracle_lights *lights, const struct oracle_scene *scene,
                          struct oracle_values *values, struct vec background);
void oracle_lights_finish(struct oracle_lights *lights);

/** Returns whether direct light includes the shape's emission. If not, paths add it where they hit
 * the shape. */
bool oracle_is_chosen(const struct oracle_scene *scene, size_t place);
/** Radiance that a surface emits towards a direction. */
struct vec oracle_emitted(const struct oracle_lights *lights, const struct oracle_hit *hit,
                          struct vec direction);
/** Radiance of the background and of all infinite lights from a direction. */
struct vec oracle_surroundings(const struct oracle_lights *lights, struct vec direction);

/**
 * Estimates the irradiance over pi from all lights but infinite ones, with shadows. `normal`:
 * shading normal. `side`: geometric normal. Both face the viewer.
 */
struct vec oracle_direct_light(const struct oracle_lights *lights, struct oracle_rays *rays,
                               const struct oracle_hit *hit, struct vec normal, struct vec side,
                               uint64_t *seed);

/** Computes direction, distance and unshadowed light of a distant, point or spot light. Returns
 * false for other lights. */
bool oracle_sent(const struct oracle_scene *scene, uint32_t light, struct vec point,
                 struct vec *towards, double *distance, struct vec *color);

#endif /* TESTS_ORACLE_LIGHTS_H */
