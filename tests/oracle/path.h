/**
 * Light along paths.
 *
 * A surface is Lambertian with its diffuse color, seen from both sides. Mirrors reflect. Glass
 * reflects and refracts by Fresnel's equations. A glossy surface is Lambertian below a mirror of
 * Schlick's strength. Roughness is ignored. A mixture is one of its materials, at random. Direct
 * light is estimated at every diffuse surface. Infinite lights and the background arrive along
 * cosine-distributed rays.
 */
#ifndef TESTS_ORACLE_PATH_H
#define TESTS_ORACLE_PATH_H

#include "oracle/lights.h"

struct oracle_tracer {
    const struct oracle_scene *scene;
    struct oracle_rays *rays;
    struct oracle_values *values;
    struct oracle_lights lights;
    struct vec mean_sky; ///< mean of the background and all infinite lights
    uint32_t bounces;    ///< 0: direct light only
    bool face_forward;   ///< previews: normals face the viewer
};

/** Estimates the radiance along a ray of the camera. */
struct vec oracle_radiance(const struct oracle_tracer *tracer, struct oracle_ray ray,
                           uint64_t *seed);

/**
 * Computes the mode "primary" of samples/demand-pbrt: lights without shadows and without a division
 * by pi, 0.4 for the surroundings, the mean of infinite lights. Mirrors and glass are gray. Equal
 * for every seed, except for alpha.
 */
struct vec oracle_preview(const struct oracle_tracer *tracer, const struct oracle_ray *ray,
                          uint64_t *seed);

#endif /* TESTS_ORACLE_PATH_H */
