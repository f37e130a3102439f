/** Rays through a scene: the nearest hit that is not cut out, by Embree. */
#ifndef TESTS_ORACLE_RAYS_H
#define TESTS_ORACLE_RAYS_H

#include "oracle/values.h"

struct oracle_ray {
    struct vec origin, direction; ///< direction: of length 1
    double longest;
    uint64_t seed; ///< decides for alpha between 0 and 1
};

struct oracle_hit {
    size_t place;
    uint32_t triangle;
    double t;
    double b1, b2; ///< barycentric coordinates of corners 1 and 2
    struct vec position;
    struct vec geometric; ///< unit normal on the shape's outside
    struct vec shading;   ///< interpolated unit normal, on the outside as the file has it
    struct oracle_point point;
    double offset; ///< keeps rays off the surface that they leave
};

struct oracle_rays;

/** Fills the members that follow from place, triangle, b1 and b2. */
void oracle_find_point(const struct oracle_scene *scene, struct oracle_hit *hit);

/** Creates the rays' scene. `values` must outlive the result. Reports errors on stderr and returns
 * NULL. */
struct oracle_rays *oracle_rays_create(const struct oracle_scene *scene,
                                       struct oracle_values *values);
void oracle_rays_destroy(struct oracle_rays *rays);

/** Returns false if the ray hits nothing. */
bool oracle_rays_trace(struct oracle_rays *rays, const struct oracle_ray *ray,
                       struct oracle_hit *hit);
/** Returns whether a surface that alpha does not cut out lies between the ray's ends. */
bool oracle_rays_is_blocked(struct oracle_rays *rays, const struct oracle_ray *ray);

#endif /* TESTS_ORACLE_RAYS_H */
