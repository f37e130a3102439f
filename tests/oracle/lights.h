/** Light that arrives at points directly. */
#ifndef TESTS_ORACLE_LIGHTS_H
#define TESTS_ORACLE_LIGHTS_H

#include "oracle/rays.h"

/** A triangle that emits light, in the world. */
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
    double weight;         ///< of all emitters
    struct vec background; ///< arrives from everywhere, beside infinite lights
};

bool oracle_lights_create(struct oracle_lights *lights, const struct oracle_scene *scene,
                          struct oracle_values *values, struct vec background);
void oracle_lights_finish(struct oracle_lights *lights);

/** Whether direct light counts what the shape emits. If not, paths count it where they hit it. */
bool oracle_is_chosen(const struct oracle_scene *scene, size_t place);
/** Radiance that a surface emits towards a direction. */
struct vec oracle_emitted(const struct oracle_lights *lights, const struct oracle_hit *hit,
                          struct vec direction);
/** Radiance of the background and of all infinite lights from a direction. */
struct vec oracle_surroundings(const struct oracle_lights *lights, struct vec direction);

/**
 * Estimates the irradiance over pi, with shadows, of all lights but infinite ones: `normal` is the
 * shading normal, `side` the geometric normal; both are on the viewer's side.
 */
struct vec oracle_direct_light(const struct oracle_lights *lights, struct oracle_rays *rays,
                               const struct oracle_hit *hit, struct vec normal, struct vec side,
                               uint64_t *seed);

/** Direction to a distant, point or spot light, its distance, and the light that it sends without
 *  shadows. False for other lights. */
bool oracle_sent(const struct oracle_scene *scene, uint32_t light, struct vec point,
                 struct vec *towards, double *distance, struct vec *color);

#endif /* TESTS_ORACLE_LIGHTS_H */
