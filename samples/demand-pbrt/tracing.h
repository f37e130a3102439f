/** How rays are traced: by the ray-tracing pipeline, where gpu.ray_tracing says so, or by a compute
 *  shader. And the descriptor set of the scene. */
#ifndef DEMAND_PBRT_TRACING_H
#define DEMAND_PBRT_TRACING_H

#include <sluice/demand.h>

#include "../../tools/common/gpu.h"
#include "pbrt_shared.h"
#include "pipeline_rays.h"

/** Zeroed is empty. */
struct tracing {
    VkDescriptorSetLayout own_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet own_set;
    VkPipeline compute;        ///< instead of `rays`
    struct pipeline_rays rays; ///< zeroed in the compute path
    VkShaderStageFlags stages;
};

/** `preview`: pixels that lack texels show coarser ones, for programs that show them. Says on
 * stderr why it failed. */
bool tracing_create(const struct gpu *gpu, const SluiceDemandLoader *loader, bool preview,
                    struct tracing *tracing);
void tracing_destroy(const struct gpu *gpu, struct tracing *tracing);

/** Names what the next launch reads and writes: buffers by PBRT_BINDING_..., and the top
 *  level, which the compute path has not. No launch is under way. */
void tracing_bind(const struct gpu *gpu, const struct tracing *tracing,
                  const VkBuffer buffers[PBRT_OWN_BUFFERS], VkAccelerationStructureKHR top);
void tracing_record(const struct tracing *tracing, VkCommandBuffer commands,
                    VkDescriptorSet demand_set, const struct PbrtLaunch *launch);

#endif /* DEMAND_PBRT_TRACING_H */
