/** Records the shapes that a picture's rays hit, and the boxes that they enter before. */
#ifndef TESTS_ORACLE_CENSUS_H
#define TESTS_ORACLE_CENSUS_H

#include "oracle/rays.h"

/** Flags by place. Arrays are owned. */
struct oracle_census {
    size_t count;
    uint8_t *is_visible; ///< true: some ray hits it first
    uint8_t *is_entered; ///< true: some ray enters the box of its vertices, not behind its hit
    uint8_t *is_material_visible; ///< by material
    uint32_t *waiting;            ///< places that no ray has entered so far
    size_t waiting_count;
    uint64_t ray_count, hit_count;
};

bool oracle_census_create(struct oracle_census *census, const struct oracle_scene *scene);
void oracle_census_finish(struct oracle_census *census);

/** Adds a ray. `hit`: NULL if the ray hits nothing. */
void oracle_census_add(struct oracle_census *census, const struct oracle_scene *scene,
                       const struct oracle_ray *ray, const struct oracle_hit *hit);

size_t oracle_census_count(const uint8_t *flags, size_t count);

#endif /* TESTS_ORACLE_CENSUS_H */
