/** The two descriptor sets of all shaders: the demand loader's, and the scene with the film. */
#ifndef TRACER_BINDINGS_H
#define TRACER_BINDINGS_H

#include <sluice/demand.h>

#include "../../tools/common/gpu.h"
#include "tracer_shared.h"

/** Zeroed is empty. */
struct bindings {
    VkDescriptorSetLayout own_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet own_set;
    VkShaderStageFlags stages;
};

struct bindings_request {
    const SluiceDemandLoader *loader;
    VkBuffer own_buffers[TRACER_OWN_BUFFERS]; ///< by TRACER_BINDING_...
    VkAccelerationStructureKHR scene;         ///< VK_NULL_HANDLE: for compute shaders
};

/** Reports errors on stderr. */
bool bindings_create(const struct gpu *gpu, const struct bindings_request *request,
                     struct bindings *bindings);
void bindings_destroy(const struct gpu *gpu, struct bindings *bindings);

/** Binds the set of a launch and the scene's, and pushes the launch's constants. */
void bindings_bind(const struct bindings *bindings, VkCommandBuffer commands,
                   VkPipelineBindPoint point, VkDescriptorSet demand_set,
                   const struct TracerLaunch *launch);

#endif /* TRACER_BINDINGS_H */
