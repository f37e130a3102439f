/** The scenes, drawn by compute and by fragment shaders, over a texture that is resident. */
#ifndef BENCH_VULKAN_SCENE_H
#define BENCH_VULKAN_SCENE_H

#include "rig.h"

#include "../../tools/common/target.h"

struct scene {
    struct rig rig;
    struct rig plain; ///< the same texture, dense: what texture() is measured on
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

/** With `everything`, all of the texture is resident afterwards, and there is a plain one. */
bool scene_create(struct scene *scene, const struct bench *bench, float anisotropy,
                  bool everything);
void scene_destroy(struct scene *scene);

VkPipeline scene_pipeline(struct scene *scene, const struct scene_constants *constants);

/** For rig_work.record and .warm_up; `user` is a struct scene_draw. */
rig_record scene_record, scene_record_warm_up;

struct BenchParams scene_params(const struct scene *scene);

#endif /* BENCH_VULKAN_SCENE_H */
