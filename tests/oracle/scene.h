/** A pbrt scene with all of its meshes in memory, and a list of the shapes in the world. */
#ifndef TESTS_ORACLE_SCENE_H
#define TESTS_ORACLE_SCENE_H

#include "oracle/vec.h"

#include <sluice/pbrt.h>

#include <stdbool.h>
#include <stddef.h>

struct oracle_box {
    struct vec least, most;
};

/** A shape in the world: a free one, or one of an instance. */
struct oracle_place {
    uint32_t shape;
    uint32_t instance; ///< SLUICE_PBRT_NONE: a free shape
    uint32_t mesh;
    double transform[12];  ///< from the space of the mesh to the world
    struct oracle_box box; ///< around the transformed vertices
};

/** Zeroed is empty. Arrays are owned. */
struct oracle_scene {
    SluicePbrtScene *pbrt;
    SluicePbrtSceneInfo info;
    SluicePbrtShape *shapes;
    SluicePbrtMaterial *materials;
    SluicePbrtTexture *textures;
    SluicePbrtLight *lights;
    SluicePbrtMesh *meshes;
    uint32_t mesh_count;
    uint32_t *mesh_of_shape; ///< SLUICE_PBRT_NONE: it cannot be read
    struct oracle_place *places;
    size_t place_count;
    uint64_t triangle_count; ///< of meshes, each counted once
    uint32_t failed_count;   ///< shapes that cannot be read
};

/** Reads a scene and all of its meshes. False, which stderr says, if there is no scene. */
bool oracle_scene_load(struct oracle_scene *scene, const char *path, bool quiet);
void oracle_scene_finish(struct oracle_scene *scene);

/** Corners of a triangle, before the transform. */
void oracle_corners(const SluicePbrtMesh *mesh, uint32_t triangle, struct vec corners[3]);

#endif /* TESTS_ORACLE_SCENE_H */
