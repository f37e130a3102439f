#include "pipeline_rays.h"

#include "box_rchit.h"
#include "box_rint.h"
#include "mesh_rahit.h"
#include "mesh_rchit.h"
#include "miss_rmiss.h"
#include "pbrt_shared.h"
#include "trace_rgen.h"

enum { BEGIN, MISS, MESH_NEAREST, MESH_ANY, BOX_NEAREST, BOX_HIT, STAGE_COUNT };
#define GROUP_COUNT 4u

static const struct {
    const uint32_t *code;
    size_t size;
    VkShaderStageFlagBits stage;
} shaders[STAGE_COUNT] = {
    [BEGIN] = {trace_rgen, sizeof trace_rgen, VK_SHADER_STAGE_RAYGEN_BIT_KHR},
    [MISS] = {miss_rmiss, sizeof miss_rmiss, VK_SHADER_STAGE_MISS_BIT_KHR},
    [MESH_NEAREST] = {mesh_rchit, sizeof mesh_rchit, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR},
    [MESH_ANY] = {mesh_rahit, sizeof mesh_rahit, VK_SHADER_STAGE_ANY_HIT_BIT_KHR},
    [BOX_NEAREST] = {box_rchit, sizeof box_rchit, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR},
    [BOX_HIT] = {box_rint, sizeof box_rint, VK_SHADER_STAGE_INTERSECTION_BIT_KHR},
};

static bool create_stages(const struct gpu *gpu, const VkSpecializationInfo *constants,
                          VkPipelineShaderStageCreateInfo stages[STAGE_COUNT])
{
    bool done = true;
    for (int i = 0; i < STAGE_COUNT; i++) {
        stages[i] = (VkPipelineShaderStageCreateInfo){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = shaders[i].stage,
            .module = gpu_create_shader(gpu, shaders[i].code, shaders[i].size),
            .pName = "main",
            .pSpecializationInfo = constants};
        done = done && stages[i].module != VK_NULL_HANDLE;
    }
    return done;
}

static bool create_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                            const VkSpecializationInfo *constants, VkPipeline *pipeline)
{
    PFN_vkCreateRayTracingPipelinesKHR create =
        (PFN_vkCreateRayTracingPipelinesKHR)vkGetDeviceProcAddr(gpu->device,
                                                                "vkCreateRayTracingPipelinesKHR");
    VkPipelineShaderStageCreateInfo stages[STAGE_COUNT];
    VkRayTracingShaderGroupCreateInfoKHR groups[GROUP_COUNT] = {
        ray_table_general_group(BEGIN), ray_table_general_group(MISS),
        [2 + PBRT_GROUP_MESH] = ray_table_general_group(VK_SHADER_UNUSED_KHR),
        [2 + PBRT_GROUP_BOX] = ray_table_general_group(VK_SHADER_UNUSED_KHR)};
    groups[2 + PBRT_GROUP_MESH].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
    groups[2 + PBRT_GROUP_MESH].closestHitShader = MESH_NEAREST;
    groups[2 + PBRT_GROUP_MESH].anyHitShader = MESH_ANY;
    groups[2 + PBRT_GROUP_BOX].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR;
    groups[2 + PBRT_GROUP_BOX].closestHitShader = BOX_NEAREST;
    groups[2 + PBRT_GROUP_BOX].intersectionShader = BOX_HIT;
    const VkRayTracingPipelineCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR,
        .stageCount = STAGE_COUNT,
        .pStages = stages,
        .groupCount = GROUP_COUNT,
        .pGroups = groups,
        .maxPipelineRayRecursionDepth = 1,
        .layout = layout};
    bool done =
        create_stages(gpu, constants, stages) &&
        gpu_check(create(gpu->device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info, NULL, pipeline),
                  "vkCreateRayTracingPipelinesKHR");
    for (int i = 0; i < STAGE_COUNT; i++)
        vkDestroyShaderModule(gpu->device, stages[i].module, NULL);
    return done;
}

bool pipeline_rays_create(const struct gpu *gpu, VkPipelineLayout layout,
                          const VkSpecializationInfo *constants, struct pipeline_rays *rays)
{
    *rays = (struct pipeline_rays){0};
    return create_pipeline(gpu, layout, constants, &rays->pipeline) &&
           ray_table_create(gpu, rays->pipeline, GROUP_COUNT, &rays->table);
}

void pipeline_rays_destroy(const struct gpu *gpu, struct pipeline_rays *rays)
{
    ray_table_destroy(gpu, &rays->table);
    vkDestroyPipeline(gpu->device, rays->pipeline, NULL);
    *rays = (struct pipeline_rays){0};
}
