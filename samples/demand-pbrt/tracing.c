#include "tracing.h"

#include <string.h>

#include "../../tools/common/text.h"
#include "box_rchit.h"
#include "box_rint.h"
#include "mesh_rahit.h"
#include "mesh_rchit.h"
#include "miss_rmiss.h"
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

static bool create_set_layout(const struct gpu *gpu, struct tracing *t)
{
    VkDescriptorSetLayoutBinding bindings[PBRT_OWN_BUFFERS + 1];
    for (uint32_t i = 0; i <= PBRT_OWN_BUFFERS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i == PBRT_BINDING_SCENE
                                  ? VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR
                                  : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            .descriptorCount = 1,
            .stageFlags = RAY_STAGES};
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = PBRT_OWN_BUFFERS + 1,
        .pBindings = bindings};
    return gpu_check(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, &t->own_layout),
                     "vkCreateDescriptorSetLayout");
}

static bool create_layouts(const struct gpu *gpu, const SluiceDemandLoader *loader,
                           struct tracing *t)
{
    VkDescriptorSetLayout demand;
    SluiceResult result = sluiceGetDemandDescriptorSetLayout(loader, &demand);
    if (result != SLUICE_SUCCESS) {
        text_say("sluiceGetDemandDescriptorSetLayout: %s", sluiceGetResultName(result));
        return false;
    }
    if (!create_set_layout(gpu, t))
        return false;
    const VkDescriptorSetLayout layouts[2] = {demand, t->own_layout};
    const VkPushConstantRange push = {RAY_STAGES, 0, sizeof(struct PbrtLaunch)};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = 2,
                                             .pSetLayouts = layouts,
                                             .pushConstantRangeCount = 1,
                                             .pPushConstantRanges = &push};
    return gpu_check(vkCreatePipelineLayout(gpu->device, &info, NULL, &t->layout),
                     "vkCreatePipelineLayout");
}

static bool allocate_set(const struct gpu *gpu, struct tracing *t)
{
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, PBRT_OWN_BUFFERS},
                                           {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    if (!gpu_check(vkCreateDescriptorPool(gpu->device, &pool, NULL, &t->pool),
                   "vkCreateDescriptorPool"))
        return false;
    const VkDescriptorSetAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = t->pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &t->own_layout};
    return gpu_check(vkAllocateDescriptorSets(gpu->device, &info, &t->own_set),
                     "vkAllocateDescriptorSets");
}

static bool create_stages(const struct gpu *gpu,
                          VkPipelineShaderStageCreateInfo stages[STAGE_COUNT])
{
    bool done = true;
    for (int i = 0; i < STAGE_COUNT; i++) {
        stages[i] = (VkPipelineShaderStageCreateInfo){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = shaders[i].stage,
            .module = gpu_create_shader(gpu, shaders[i].code, shaders[i].size),
            .pName = "main"};
        done = done && stages[i].module != VK_NULL_HANDLE;
    }
    return done;
}

static bool create_pipeline(const struct gpu *gpu, struct tracing *t)
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
        .layout = t->layout};
    bool done =
        create_stages(gpu, stages) &&
        gpu_check(create(gpu->device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info, NULL, &t->pipeline),
                  "vkCreateRayTracingPipelinesKHR");
    for (int i = 0; i < STAGE_COUNT; i++)
        vkDestroyShaderModule(gpu->device, stages[i].module, NULL);
    return done;
}

bool tracing_create(const struct gpu *gpu, const SluiceDemandLoader *loader, struct tracing *t)
{
    *t = (struct tracing){0};
    return create_layouts(gpu, loader, t) && allocate_set(gpu, t) && create_pipeline(gpu, t) &&
           ray_table_create(gpu, t->pipeline, GROUP_COUNT, &t->table);
}

void tracing_destroy(const struct gpu *gpu, struct tracing *t)
{
    ray_table_destroy(gpu, &t->table);
    vkDestroyPipeline(gpu->device, t->pipeline, NULL);
    vkDestroyDescriptorPool(gpu->device, t->pool, NULL);
    vkDestroyPipelineLayout(gpu->device, t->layout, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, t->own_layout, NULL);
    *t = (struct tracing){0};
}

void tracing_bind(const struct gpu *gpu, const struct tracing *t,
                  const VkBuffer buffers[PBRT_OWN_BUFFERS], VkAccelerationStructureKHR top)
{
    VkDescriptorBufferInfo infos[PBRT_OWN_BUFFERS];
    for (uint32_t i = 0; i < PBRT_OWN_BUFFERS; i++)
        infos[i] = (VkDescriptorBufferInfo){buffers[i], 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSetAccelerationStructureKHR structure = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR,
        .accelerationStructureCount = 1,
        .pAccelerationStructures = &top};
    const VkWriteDescriptorSet writes[2] = {
        {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
         .dstSet = t->own_set,
         .descriptorCount = PBRT_OWN_BUFFERS,
         .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
         .pBufferInfo = infos},
        {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
         .pNext = &structure,
         .dstSet = t->own_set,
         .dstBinding = PBRT_BINDING_SCENE,
         .descriptorCount = 1,
         .descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR}};
    vkUpdateDescriptorSets(gpu->device, 2, writes, 0, NULL);
}

void tracing_record(const struct tracing *t, VkCommandBuffer commands, VkDescriptorSet demand_set,
                    const struct PbrtLaunch *launch)
{
    const VkDescriptorSet sets[2] = {demand_set, t->own_set};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, t->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, t->layout, 0, 2, sets,
                            0, NULL);
    vkCmdPushConstants(commands, t->layout, RAY_STAGES, 0, sizeof *launch, launch);
    ray_table_record(&t->table, commands, PBRT_ROW_WIDTH,
                     (launch->count + PBRT_ROW_WIDTH - 1) / PBRT_ROW_WIDTH);
}
