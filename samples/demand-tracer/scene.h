/** A garden of things on pedestals and leaves between them, each with a texture of its own. */
#ifndef TRACER_SCENE_H
#define TRACER_SCENE_H

#include "../common/vecmath.h"
#include "bvh.h"
#include "shapes.h"

/** What a texture is put on: patterns follow it. */
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
    enum shape_kind *kinds;           ///< owned; of each instance
    uint32_t instance_count, instance_capacity;
    uint32_t texture_count;
    struct bvh bvh; ///< of shapes, and of instances from `bvh.scene_root` on
};

struct scene_camera {
    struct vec3 eye, target;
    float field_of_view; ///< radians, vertical
};

/**
 * Builds everything on the host. The same seed and number of textures, at least 3, give the same
 * scene: texture 0 is the ground's, a fifth are of leaves. Says on stderr why it failed.
 */
bool scene_build(uint32_t seed, uint32_t texture_count, struct scene *scene);
void scene_finish(struct scene *scene);

enum texture_use scene_texture_use(uint32_t texture, uint32_t texture_count);
struct scene_camera scene_default_camera(void);
/** The camera after a share of a turn around the vertical axis through its target. 1: as it is. */
struct scene_camera scene_turn_camera(const struct scene_camera *camera, double share);

#endif /* TRACER_SCENE_H */
