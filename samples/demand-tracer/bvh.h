/**
 * Box hierarchies for devices without ray tracing: one per shape, and one over all instances.
 * shaders/bvh.glsl walks through them.
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
 * Adds a hierarchy over the triangles from `first_index` / 3 on, and sorts them in the mesh.
 * `first` of its leaves counts from the shape's first triangle. Returns false when out of memory.
 */
bool bvh_add_triangles(struct bvh *bvh, struct mesh *mesh, uint32_t first_index,
                       uint32_t index_count, uint32_t *root);
/** Adds a hierarchy over instances of added shapes. Each leaf has one instance. */
bool bvh_add_instances(struct bvh *bvh, const struct TracerInstance *instances, uint32_t count);
void bvh_finish(struct bvh *bvh);

#endif /* TRACER_BVH_H */
