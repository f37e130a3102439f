#include "tracing.h"

#include <string.h>

#include "../../tools/common/text.h"
#include "trace_comp.h"

static bool create_set_layout(const struct gpu *gpu, struct tracing *t)
{
    VkDescriptorSetLayoutBinding bindings[PBRT_OWN_BUFFERS + 1];
    const uint32_t count = PBRT_OWN_BUFFERS + (gpu->ray_tracing ? 1 : 0);
    for (uint32_t i = 0; i < count; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i == PBRT_BINDING_SCENE
                                  ? VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR
                                  : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            .descriptorCount = 1,
            .stageFlags = t->stages};
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = count,
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
    const VkPushConstantRange push = {t->stages, 0, sizeof(struct PbrtLaunch)};
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
                                             .poolSizeCount = gpu->ray_tracing ? 2 : 1,
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

bool tracing_create(const struct gpu *gpu, const SluiceDemandLoader *loader, bool preview,
                    struct tracing *t)
{
    const VkBool32 constant = preview;
    const VkSpecializationMapEntry entry = {PBRT_CONSTANT_PREVIEW, 0, sizeof constant};
    const VkSpecializationInfo constants = {1, &entry, sizeof constant, &constant};
    *t = (struct tracing){.stages = gpu->ray_tracing ? RAY_STAGES : VK_SHADER_STAGE_COMPUTE_BIT};
    if (!create_layouts(gpu, loader, t) || !allocate_set(gpu, t))
        return false;
    if (gpu->ray_tracing)
        return pipeline_rays_create(gpu, t->layout, &constants, &t->rays);
    return gpu_create_compute_pipeline(gpu, t->layout, trace_comp, sizeof trace_comp, &constants,
                                       &t->compute);
}

void tracing_destroy(const struct gpu *gpu, struct tracing *t)
{
    pipeline_rays_destroy(gpu, &t->rays);
    vkDestroyPipeline(gpu->device, t->compute, NULL);
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
    vkUpdateDescriptorSets(gpu->device, gpu->ray_tracing ? 2 : 1, writes, 0, NULL);
}

void tracing_record(const struct tracing *t, VkCommandBuffer commands, VkDescriptorSet demand_set,
                    const struct PbrtLaunch *launch)
{
    const VkDescriptorSet sets[2] = {demand_set, t->own_set};
    const VkPipelineBindPoint point =
        t->compute ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR;
    const uint32_t rows = (launch->count + PBRT_ROW_WIDTH - 1) / PBRT_ROW_WIDTH;
    vkCmdBindPipeline(commands, point, t->compute ? t->compute : t->rays.pipeline);
    vkCmdBindDescriptorSets(commands, point, t->layout, 0, 2, sets, 0, NULL);
    vkCmdPushConstants(commands, t->layout, t->stages, 0, sizeof *launch, launch);
    if (t->compute)
        vkCmdDispatch(commands, PBRT_ROW_WIDTH / PBRT_GROUP_SIZE, rows, 1);
    else
        ray_table_record(&t->rays.table, commands, PBRT_ROW_WIDTH, rows);
}
