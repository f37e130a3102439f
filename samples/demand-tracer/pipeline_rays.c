#include "pipeline_rays.h"

#include <stdlib.h>
#include <string.h>

#include "accel.h"
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

static VkRayTracingShaderGroupCreateInfoKHR general_group(uint32_t stage)
{
    return (VkRayTracingShaderGroupCreateInfoKHR){
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
        .type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR,
        .generalShader = stage,
        .closestHitShader = VK_SHADER_UNUSED_KHR,
        .anyHitShader = VK_SHADER_UNUSED_KHR,
        .intersectionShader = VK_SHADER_UNUSED_KHR};
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
        general_group(STAGE_BEGIN), general_group(STAGE_MISS), general_group(VK_SHADER_UNUSED_KHR)};
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

static uint32_t round_up(uint32_t value, uint32_t alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

static VkPhysicalDeviceRayTracingPipelinePropertiesKHR get_properties(const struct gpu *gpu)
{
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR rays = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &rays};
    vkGetPhysicalDeviceProperties2(gpu->physical_device, &properties);
    return rays;
}

/** One group after the other, each as aligned as the device wants groups to be. */
static void write_table(const struct gpu *gpu, const uint8_t *handles, uint32_t handle_size,
                        uint32_t alignment, struct ray_pipeline *pipeline)
{
    const VkDeviceSize stride = round_up(handle_size, alignment);
    VkDeviceAddress base = accel_buffer_address(gpu, pipeline->table.buffer);
    VkDeviceSize first = (alignment - base % alignment) % alignment;
    for (uint32_t i = 0; i < GROUP_COUNT; i++) {
        VkDeviceSize place = first + i * stride;
        memcpy((uint8_t *)pipeline->table.mapped + place, handles + (size_t)i * handle_size,
               handle_size);
        pipeline->groups[i] = (VkStridedDeviceAddressRegionKHR){base + place, stride, stride};
    }
}

static bool create_table(const struct gpu *gpu, struct ray_pipeline *pipeline)
{
    PFN_vkGetRayTracingShaderGroupHandlesKHR get_handles =
        (PFN_vkGetRayTracingShaderGroupHandlesKHR)vkGetDeviceProcAddr(
            gpu->device, "vkGetRayTracingShaderGroupHandlesKHR");
    const VkPhysicalDeviceRayTracingPipelinePropertiesKHR rays = get_properties(gpu);
    const uint32_t size = rays.shaderGroupHandleSize, alignment = rays.shaderGroupBaseAlignment;
    uint8_t *handles = malloc((size_t)GROUP_COUNT * size);
    bool done = handles &&
                gpu_check(get_handles(gpu->device, pipeline->pipeline, 0, GROUP_COUNT,
                                      (size_t)GROUP_COUNT * size, handles),
                          "vkGetRayTracingShaderGroupHandlesKHR") &&
                gpu_create_buffer(gpu, (GROUP_COUNT + 1) * round_up(size, alignment),
                                  VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR |
                                      VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                                  &pipeline->table);
    if (done)
        write_table(gpu, handles, size, alignment, pipeline);
    free(handles);
    return done;
}

bool ray_pipeline_create(const struct gpu *gpu, VkPipelineLayout layout, bool preview, bool needs,
                         struct ray_pipeline *pipeline)
{
    *pipeline = (struct ray_pipeline){
        .trace = (PFN_vkCmdTraceRaysKHR)vkGetDeviceProcAddr(gpu->device, "vkCmdTraceRaysKHR")};
    return create_pipeline(gpu, layout, preview, needs, pipeline) && create_table(gpu, pipeline);
}

void ray_pipeline_destroy(const struct gpu *gpu, struct ray_pipeline *pipeline)
{
    vkDestroyPipeline(gpu->device, pipeline->pipeline, NULL);
    gpu_destroy_buffer(gpu, &pipeline->table);
    *pipeline = (struct ray_pipeline){0};
}

void ray_pipeline_record(const struct ray_pipeline *pipeline, VkCommandBuffer commands,
                         uint32_t pixel_count)
{
    const VkStridedDeviceAddressRegionKHR none = {0};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline->pipeline);
    pipeline->trace(commands, &pipeline->groups[0], &pipeline->groups[1], &pipeline->groups[2],
                    &none, TRACER_ROW_WIDTH,
                    (pixel_count + TRACER_ROW_WIDTH - 1) / TRACER_ROW_WIDTH, 1);
}
