/** The scene as the text has it, and the boxes of everything in it. No device. */
#ifndef DEMAND_PBRT_SCENE_H
#define DEMAND_PBRT_SCENE_H

#include <sluice/pbrt.h>

#include <stdbool.h>

#include "clusters.h"

/** Who waits for a scene that is opened on a thread. */
struct scene_watch {
    const atomic_bool *canceled;      ///< true: scene_open and scene_cluster fail soon
    atomic_uint_least64_t *read_size; ///< bytes of text that were read
};

/** Zeroed is empty. */
struct scene {
    SluicePbrtScene *pbrt;
    SluicePbrtSceneInfo info;
    const SluicePbrtInstance *instances;
    SluicePbrtBounds *boxes;         ///< owned; of each shape. Empty: the shape is not placed.
    SluicePbrtBounds *object_boxes;  ///< owned; of each object
    SluicePbrtBounds box;            ///< of everything
    uint64_t node_count;             ///< free shapes, and instances with something in them
    uint64_t place_count;            ///< shapes in the world; those of objects once per instance
    struct clusters clusters;        ///< of the nodes; empty: there are few of them
    const struct scene_watch *watch; ///< borrowed; NULL: nobody
    double parse_seconds;            ///< of the text
    double bounds_seconds;           ///< of the boxes: vertices of PLY files
    double cluster_seconds;          ///< of the clusters
};

/** A shape in the world. `instance` is SLUICE_PBRT_NONE for shapes that are no part of an object.
 *  `shape` is SLUICE_PBRT_NONE for an instance as a whole, and both are for the scene. */
struct scene_node {
    uint32_t instance, shape;
};

/** `bounds_path`: file with boxes of PLY files, which is used and written anew; may be NULL.
 *  `watch` may be NULL, and outlives scene_cluster. Says on stderr why it failed, unless it was
 *  canceled. */
bool scene_open(const char *path, const char *bounds_path, const struct scene_watch *watch,
                struct scene *scene);
void scene_finish(struct scene *scene);

bool scene_box_is_empty(const SluicePbrtBounds *box);
/** The box of a node in the world. Empty if nothing of it is placed. */
SluicePbrtBounds scene_node_box(const struct scene *scene, struct scene_node node);
/** From the space of the node's shape to the world. */
void scene_node_transform(const struct scene *scene, struct scene_node node, float transform[12]);
/** Range of the shapes of an instance's object. */
SluicePbrtObject scene_object_of(const struct scene *scene, uint32_t instance);

SluicePbrtShape scene_shape(const struct scene *scene, uint32_t index);
SluicePbrtMaterial scene_material(const struct scene *scene, uint32_t index);
SluicePbrtTexture scene_texture(const struct scene *scene, uint32_t index);
SluicePbrtLight scene_light(const struct scene *scene, uint32_t index);

/** Calls `visit` for every node that is placed as one box at first: free shapes and instances.
 *  Ends with false when `visit` returns false. */
bool scene_for_each(const struct scene *scene,
                    bool (*visit)(void *user_data, struct scene_node node), void *user_data);

/** Sorts all nodes to clusters of `size` at most, if there are more of them. Says on stderr why it
 *  failed. */
bool scene_cluster(struct scene *scene, uint32_t size);
/** The node of a key in the clusters. */
struct scene_node scene_node_of_key(const struct scene *scene, uint32_t key);

/** Writes a line for each shape in the world. Says on stderr why it failed. */
bool scene_dump(const struct scene *scene, const char *path);

#endif /* DEMAND_PBRT_SCENE_H */
