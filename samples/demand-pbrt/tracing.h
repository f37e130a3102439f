/** Pipelines that trace rays, and the descriptor set of the scene. The ray-tracing pipeline is used
 * if gpu.ray_tracing is set, otherwise a compute shader. */
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
    VkPipeline compute;        ///< used instead of `rays` in the compute path
    struct pipeline_rays rays; ///< zeroed in the compute path
    VkShaderStageFlags stages;
};

/** `preview`: pixels show coarser levels where texels are missing. Reports errors on stderr. */
bool tracing_create(const struct gpu *gpu, const SluiceDemandLoader *loader, bool preview,
                    struct tracing *tracing);
void tracing_destroy(const struct gpu *gpu, struct tracing *tracing);

/** Sets what the next launch reads and writes: buffers by PBRT_BINDING_..., and the top level,
 * which the compute path does without. Call only while no launch is running. */
void tracing_bind(const struct gpu *gpu, const struct tracing *tracing,
                  const VkBuffer buffers[PBRT_OWN_BUFFERS], VkAccelerationStructureKHR top);
void tracing_record(const struct tracing *tracing, VkCommandBuffer commands,
                    VkDescriptorSet demand_set, const struct PbrtLaunch *launch);

#endif /* DEMAND_PBRT_TRACING_H */
