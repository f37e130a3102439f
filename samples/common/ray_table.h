/** Shader binding table of a ray-tracing pipeline. */
#ifndef SAMPLES_COMMON_RAY_TABLE_H
#define SAMPLES_COMMON_RAY_TABLE_H

#include "../../tools/common/gpu.h"

/** Stages that use a descriptor set of a ray-tracing pipeline. */
#define RAY_STAGES                                                                                 \
    (VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR |                               \
     VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR |                       \
     VK_SHADER_STAGE_INTERSECTION_BIT_KHR)

/** Regions for vkCmdTraceRaysKHR. Zeroed is empty. */
struct ray_table {
    struct gpu_buffer buffer;
    VkStridedDeviceAddressRegionKHR begin, miss, hit;
    PFN_vkCmdTraceRaysKHR trace;
};

/** Returns a group of one stage: ray generation or miss. */
VkRayTracingShaderGroupCreateInfoKHR ray_table_general_group(uint32_t stage);

/**
 * Gets the handles of a pipeline's groups. The first group generates rays, the second is the miss
 * group, all others are hit groups. Reports errors on stderr.
 */
bool ray_table_create(const struct gpu *gpu, VkPipeline pipeline, uint32_t group_count,
                      struct ray_table *table);
void ray_table_destroy(const struct gpu *gpu, struct ray_table *table);

/** Records a launch of width x height rays with the bound pipeline. */
void ray_table_record(const struct ray_table *table, VkCommandBuffer commands, uint32_t width,
                      uint32_t height);

VkDeviceAddress ray_buffer_address(const struct gpu *gpu, VkBuffer buffer);

#endif /* SAMPLES_COMMON_RAY_TABLE_H */
