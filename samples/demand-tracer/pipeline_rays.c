#include "pipeline_rays.h"

#include "trace_rahit.h"
#include "trace_rchit.h"
#include "trace_rgen.h"
#include "trace_rmiss.h"

enum stage { STAGE_BEGIN, STAGE_MISS, STAGE_NEAREST, STAGE_ANY, STAGE_COUNT };
#define GROUP_COUNT 3u

static const struct {
    const uint32_t *code;
    size_t size;
    VkShaderStageFlagBits stage;
} shaders[STAGE_COUNT] = {
    [STAGE_BEGIN] = {trace_rgen, sizeof trace_rgen, VK_SHADER_STAGE_RAYGEN_BIT_KHR},
    [STAGE_MISS] = {trace_rmiss, sizeof trace_rmiss, VK_SHADER_STAGE_MISS_BIT_KHR},
    [STAGE_NEAREST] = {trace_rchit, sizeof trace_rchit, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR},
    [STAGE_ANY] = {trace_rahit, sizeof trace_rahit, VK_SHADER_STAGE_ANY_HIT_BIT_KHR},
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

static bool create_pipeline(const struct gpu *gpu, VkPipelineLayout layout, bool preview,
                            bool needs, struct ray_pipeline *pipeline)
{
    PFN_vkCreateRayTracingPipelinesKHR create =
        (PFN_vkCreateRayTracingPipelinesKHR)vkGetDeviceProcAddr(gpu->device,
                                                                "vkCreateRayTracingPipelinesKHR");
    const VkBool32 values[2] = {preview, needs};
    const VkSpecializationMapEntry entries[2] = {
        {TRACER_CONSTANT_PREVIEW, 0, sizeof values[0]},
        {TRACER_CONSTANT_NEEDS, sizeof values[0], sizeof values[1]}};
    const VkSpecializationInfo constants = {2, entries, sizeof values, values};
    VkPipelineShaderStageCreateInfo stages[STAGE_COUNT];
    VkRayTracingShaderGroupCreateInfoKHR groups[GROUP_COUNT] = {
        ray_table_general_group(STAGE_BEGIN), ray_table_general_group(STAGE_MISS),
        ray_table_general_group(VK_SHADER_UNUSED_KHR)};
    groups[2].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
    groups[2].closestHitShader = STAGE_NEAREST;
    groups[2].anyHitShader = STAGE_ANY;
    VkRayTracingPipelineCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR,
        .stageCount = STAGE_COUNT,
        .pStages = stages,
        .groupCount = GROUP_COUNT,
        .pGroups = groups,
        .maxPipelineRayRecursionDepth = 1,
        .layout = layout};
    bool done = create_stages(gpu, &constants, stages) &&
                gpu_check(create(gpu->device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info, NULL,
                                 &pipeline->pipeline),
                          "vkCreateRayTracingPipelinesKHR");
    for (int i = 0; i < STAGE_COUNT; i++)
        vkDestroyShaderModule(gpu->device, stages[i].module, NULL);
    return done;
}

bool ray_pipeline_create(const struct gpu *gpu, VkPipelineLayout layout, bool preview, bool needs,
                         struct ray_pipeline *pipeline)
{
    *pipeline = (struct ray_pipeline){0};
    return create_pipeline(gpu, layout, preview, needs, pipeline) &&
           ray_table_create(gpu, pipeline->pipeline, GROUP_COUNT, &pipeline->table);
}

void ray_pipeline_destroy(const struct gpu *gpu, struct ray_pipeline *pipeline)
{
    vkDestroyPipeline(gpu->device, pipeline->pipeline, NULL);
    ray_table_destroy(gpu, &pipeline->table);
    *pipeline = (struct ray_pipeline){0};
}

void ray_pipeline_record(const struct ray_pipeline *pipeline, VkCommandBuffer commands,
                         uint32_t pixel_count)
{
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline->pipeline);
    ray_table_record(&pipeline->table, commands, TRACER_ROW_WIDTH,
                     (pixel_count + TRACER_ROW_WIDTH - 1) / TRACER_ROW_WIDTH);
}
