/** Triangles of emitting shapes, on which paths sample points. */
#ifndef DEMAND_PBRT_EMITTERS_H
#define DEMAND_PBRT_EMITTERS_H

#include "pbrt_shared.h"
#include "scene.h"
#include "table.h"

/** Returns PbrtPlace.flags of a shape with a transform to the world. */
uint32_t emitters_place_flags(const struct scene *scene, const SluicePbrtShape *shape,
                              const float transform[12]);

/**
 * Fills a table of struct PbrtEmitter, in the order of the scene and independent of what is built,
 * and the densities in `lights`. Reads the meshes of emitting shapes and builds nothing. Without
 * `are_read` the table stays empty. Reports errors on stderr.
 */
bool emitters_create(const struct gpu *gpu, const struct scene *scene, bool are_read,
                     struct table *lights, struct table *emitters);

#endif /* DEMAND_PBRT_EMITTERS_H */
