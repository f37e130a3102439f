/** The scenes, drawn by compute and by fragment shaders, with a resident texture. */
#ifndef BENCH_VULKAN_SCENE_H
#define BENCH_VULKAN_SCENE_H

#include "rig.h"

#include "../../tools/common/target.h"

struct scene {
    struct rig rig;
    struct rig plain; ///< the texture in dense mode, for texture()
    struct target target;
    bool has_target;
};

struct scene_draw {
    struct scene *scene;
    bool fragment;
    VkPipeline pipeline, warm_up;
    struct BenchParams params;
};

struct scene_constants {
    bool fragment, streamed, counting;
    uint32_t scene, feedback;
    float anisotropy;
};

/** Creates a scene. `everything`: makes all of the texture resident, and creates a plain one. */
bool scene_create(struct scene *scene, const struct bench *bench, float anisotropy,
                  bool everything);
void scene_destroy(struct scene *scene);

VkPipeline scene_pipeline(struct scene *scene, const struct scene_constants *constants);

/** Callbacks for rig_work.record and .warm_up. `user` is a struct scene_draw. */
rig_record scene_record, scene_record_warm_up;

struct BenchParams scene_params(const struct scene *scene);

#endif /* BENCH_VULKAN_SCENE_H */
