/** Triangles of shapes that emit, which paths choose points on. */
#ifndef DEMAND_PBRT_EMITTERS_H
#define DEMAND_PBRT_EMITTERS_H

#include "pbrt_shared.h"
#include "scene.h"
#include "table.h"

/** PbrtPlace.flags of a shape whose transform to the world is `transform`. */
uint32_t emitters_place_flags(const struct scene *scene, const SluicePbrtShape *shape,
                              const float transform[12]);

/**
 * Fills a table of struct PbrtEmitter in the order of the scene, whatever is built, and the
 * densities in `lights`. The meshes of shapes that emit are read; nothing is built. Without
 * `are_read` the table stays empty. Says on stderr why it failed.
 */
bool emitters_create(const struct gpu *gpu, const struct scene *scene, bool are_read,
                     struct table *lights, struct table *emitters);

#endif /* DEMAND_PBRT_EMITTERS_H */
