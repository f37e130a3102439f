/** A pbrt scene with all its meshes in memory, and a list of its placed shapes. */
#ifndef TESTS_ORACLE_SCENE_H
#define TESTS_ORACLE_SCENE_H

#include "oracle/vec.h"

#include <sluice/pbrt.h>

#include <stdbool.h>
#include <stddef.h>

struct oracle_box {
    struct vec least, most;
};

/** A placed shape: a free one, or one of an instance. */
struct oracle_place {
    uint32_t shape;
    uint32_t instance; ///< SLUICE_PBRT_NONE: a free shape
    uint32_t mesh;
    double transform[12];  ///< transform from the mesh's space to world space
    struct oracle_box box; ///< bounds of the transformed vertices
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
    uint32_t *mesh_of_shape; ///< SLUICE_PBRT_NONE: unreadable
    struct oracle_place *places;
    size_t place_count;
    uint64_t triangle_count; ///< triangles of all meshes, each mesh counted once
    uint32_t failed_count;   ///< unreadable shapes
};

/** Reads a scene and all its meshes. Returns false if there is no scene, and reports it on
 * stderr. */
bool oracle_scene_load(struct oracle_scene *scene, const char *path, bool quiet);
void oracle_scene_finish(struct oracle_scene *scene);

/** Reads the corners of a triangle, without the transform. */
void oracle_corners(const SluicePbrtMesh *mesh, uint32_t triangle, struct vec corners[3]);

#endif /* TESTS_ORACLE_SCENE_H */
