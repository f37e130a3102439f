/** The ray-tracing pipeline. */
#ifndef DEMAND_PBRT_PIPELINE_RAYS_H
#define DEMAND_PBRT_PIPELINE_RAYS_H

#include "../common/ray_table.h"

/** Zeroed is empty. */
struct pipeline_rays {
    VkPipeline pipeline;
    struct ray_table table;
};

/** `constants`: specialization constants of all shaders. Reports errors on stderr. */
bool pipeline_rays_create(const struct gpu *gpu, VkPipelineLayout layout,
                          const VkSpecializationInfo *constants, struct pipeline_rays *rays);
void pipeline_rays_destroy(const struct gpu *gpu, struct pipeline_rays *rays);

#endif /* DEMAND_PBRT_PIPELINE_RAYS_H */
