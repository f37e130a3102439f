/**
 * Hierarchies of boxes for devices that trace no rays themselves: one for each shape, and one over
 * all instances. Shaders go down them, see shaders/bvh.glsl.
 */
#ifndef TRACER_BVH_H
#define TRACER_BVH_H

#include "shapes.h"

/** Zeroed is empty. */
struct bvh {
    struct TracerNode *nodes; ///< owned
    size_t count, capacity;
    uint32_t scene_root; ///< node over all instances
};

/**
 * Adds a hierarchy over triangles `first_index` / 3 and on, and sorts these in the mesh: `first` of
 * its leaves counts triangles from the shape's first one. False when out of memory.
 */
bool bvh_add_triangles(struct bvh *bvh, struct mesh *mesh, uint32_t first_index,
                       uint32_t index_count, uint32_t *root);
/** Over instances, whose shapes were added before; leaves have one each. */
bool bvh_add_instances(struct bvh *bvh, const struct TracerInstance *instances, uint32_t count);
void bvh_finish(struct bvh *bvh);

#endif /* TRACER_BVH_H */
