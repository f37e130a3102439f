/** Triangle meshes of the scene's shapes: ground, things, leaves. */
#ifndef TRACER_SHAPES_H
#define TRACER_SHAPES_H

#include <stdbool.h>
#include <stddef.h>

#include "tracer_shared.h"

/** Triangles of all shapes. Zeroed is empty. */
struct mesh {
    struct TracerVertex *vertices; ///< owned
    uint32_t *indices;             ///< owned; three per triangle
    size_t vertex_count, vertex_capacity;
    size_t index_count, index_capacity;
};

enum shape_kind {
    SHAPE_GROUND,  ///< 1 wide for a unit of x and z; height from ground_height
    SHAPE_BALL,    ///< radius 1, centered at the origin
    SHAPE_GOURD,   ///< ball with ribs
    SHAPE_PEBBLE,  ///< dented ball
    SHAPE_BOX,     ///< 2 in each direction, with rounded edges
    SHAPE_VASE,    ///< stands on y = 0, about 2 high
    SHAPE_SHRUB,   ///< leaves that rise and droop from the origin, about 1 high
    SHAPE_GRASSES, ///< narrow upright leaves
    SHAPE_COUNT
};

#define GROUND_EXTENT 70.0f ///< meters from the middle to an edge

/** Height in meters at (x, z). */
float ground_height(float x, float z);

/** Appends a shape's triangles. Returns false when out of memory; the mesh is unchanged then. */
bool shapes_append(enum shape_kind kind, struct mesh *mesh);
void mesh_finish(struct mesh *mesh);

#endif /* TRACER_SHAPES_H */
