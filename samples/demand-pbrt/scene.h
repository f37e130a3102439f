/** The parsed scene and the bounds of its shapes. Needs no device. */
#ifndef DEMAND_PBRT_SCENE_H
#define DEMAND_PBRT_SCENE_H

#include <sluice/pbrt.h>

#include <stdbool.h>

#include "clusters.h"

/** Cancellation and progress of a scene that a thread opens. */
struct scene_watch {
    const atomic_bool *canceled;      ///< true: scene_open and scene_cluster fail soon
    atomic_uint_least64_t *read_size; ///< bytes of text read so far
};

/** Zeroed is empty. */
struct scene {
    SluicePbrtScene *pbrt;
    SluicePbrtSceneInfo info;
    const SluicePbrtInstance *instances;
    SluicePbrtBounds *boxes;         ///< owned; by shape. Empty: the shape is not placed.
    SluicePbrtBounds *object_boxes;  ///< owned; by object
    SluicePbrtBounds box;            ///< bounds of the whole scene
    uint64_t node_count;             ///< free shapes, and instances that are not empty
    uint64_t place_count;            ///< placed shapes; shapes of an object count once per instance
    struct clusters clusters;        ///< clusters of the nodes; empty: few nodes
    const struct scene_watch *watch; ///< borrowed; may be NULL
    double parse_seconds;            ///< time to parse the text
    double bounds_seconds;           ///< time to compute bounds from the vertices of PLY files
    double cluster_seconds;          ///< time to build the clusters
};

/** A node of the scene. A shape outside all objects has `instance` SLUICE_PBRT_NONE. A whole
 * instance has `shape` SLUICE_PBRT_NONE. The whole scene has both. */
struct scene_node {
    uint32_t instance, shape;
};

/** `bounds_path`: cache file for bounds of PLY files, read and rewritten; may be NULL. `watch` may
 * be NULL, and must outlive scene_cluster. Reports errors on stderr, but not its cancellation. */
bool scene_open(const char *path, const char *bounds_path, const struct scene_watch *watch,
                struct scene *scene);
void scene_finish(struct scene *scene);

bool scene_box_is_empty(const SluicePbrtBounds *box);
/** Returns the node's bounds in world space. Empty if nothing of it is placed. */
SluicePbrtBounds scene_node_box(const struct scene *scene, struct scene_node node);
/** Writes the transform from the space of the node's shape to world space. */
void scene_node_transform(const struct scene *scene, struct scene_node node, float transform[12]);
/** Returns the range of shapes of an instance's object. */
SluicePbrtObject scene_object_of(const struct scene *scene, uint32_t instance);

SluicePbrtShape scene_shape(const struct scene *scene, uint32_t index);
SluicePbrtMaterial scene_material(const struct scene *scene, uint32_t index);
SluicePbrtTexture scene_texture(const struct scene *scene, uint32_t index);
SluicePbrtLight scene_light(const struct scene *scene, uint32_t index);

/** Calls `visit` for every node that starts as one box: free shapes and instances. Stops and
 * returns false when `visit` returns false. */
bool scene_for_each(const struct scene *scene,
                    bool (*visit)(void *user_data, struct scene_node node), void *user_data);

/** Groups all nodes into clusters of at most `size`, if there are more than `size`. Reports errors
 * on stderr. */
bool scene_cluster(struct scene *scene, uint32_t size);
/** Returns the node of a cluster key. */
struct scene_node scene_node_of_key(const struct scene *scene, uint32_t key);

/** Writes a line per shape in the world. Reports errors on stderr. */
bool scene_dump(const struct scene *scene, const char *path);

#endif /* DEMAND_PBRT_SCENE_H */
