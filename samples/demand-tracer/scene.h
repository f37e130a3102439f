/** A garden of things on pedestals with leaves between them. Each has a texture of its own. */
#ifndef TRACER_SCENE_H
#define TRACER_SCENE_H

#include "../common/vecmath.h"
#include "bvh.h"
#include "shapes.h"

/** Use of a texture. Selects its pattern. */
enum texture_use { TEXTURE_OF_GROUND, TEXTURE_OF_THING, TEXTURE_OF_LEAVES };

struct shape {
    uint32_t first_index, index_count; ///< in the mesh
    uint32_t root_node;                ///< in the hierarchy
    bool cut_out;
};

struct scene {
    struct mesh mesh;
    struct shape shapes[SHAPE_COUNT];
    struct TracerInstance *instances; ///< owned; `texture` is 0 to texture_count - 1
    enum shape_kind *kinds;           ///< owned; by instance
    uint32_t instance_count, instance_capacity;
    uint32_t texture_count;
    struct bvh bvh; ///< trees of shapes; the tree over instances begins at `bvh.scene_root`
};

struct scene_camera {
    struct vec3 eye, target;
    float field_of_view; ///< radians, vertical
};

/**
 * Builds the scene on the host. Equal seeds and texture counts, at least 3, give equal scenes.
 * Texture 0 belongs to the ground; a fifth are leaves. Reports errors on stderr.
 */
bool scene_build(uint32_t seed, uint32_t texture_count, struct scene *scene);
void scene_finish(struct scene *scene);

enum texture_use scene_texture_use(uint32_t texture, uint32_t texture_count);
struct scene_camera scene_default_camera(void);
/** Turns the camera around the vertical axis through its target by a share of a full turn. 1:
 * unchanged. */
struct scene_camera scene_turn_camera(const struct scene_camera *camera, double share);

#endif /* TRACER_SCENE_H */
