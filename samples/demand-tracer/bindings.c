#include "bindings.h"

#include "../common/ray_table.h"
#include "../../tools/common/text.h"

#include <string.h>

static bool create_set_layout(const struct gpu *gpu, bool has_scene, struct bindings *b)
{
    VkDescriptorSetLayoutBinding bindings[TRACER_OWN_BUFFERS + 1];
    for (uint32_t i = 0; i < TRACER_OWN_BUFFERS; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                           .descriptorCount = 1,
                                           .stageFlags = b->stages};
    bindings[TRACER_OWN_BUFFERS] = (VkDescriptorSetLayoutBinding){
        .binding = TRACER_BINDING_SCENE,
        .descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
        .descriptorCount = 1,
        .stageFlags = b->stages};
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = TRACER_OWN_BUFFERS + has_scene,
                                            .pBindings = bindings};
    return gpu_check(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, &b->own_layout),
                     "vkCreateDescriptorSetLayout");
}

static bool create_layouts(const struct gpu *gpu, const struct bindings_request *request,
                           struct bindings *b)
{
    const bool has_scene = request->scene != VK_NULL_HANDLE;
    VkDescriptorSetLayout demand;
    SluiceResult result = sluiceGetDemandDescriptorSetLayout(request->loader, &demand);
    if (result != SLUICE_SUCCESS) {
        text_say("sluiceGetDemandDescriptorSetLayout: %s", sluiceGetResultName(result));
        return false;
    }
    if (!create_set_layout(gpu, has_scene, b))
        return false;
    const VkDescriptorSetLayout layouts[2] = {demand, b->own_layout};
    const VkPushConstantRange push = {b->stages, 0, sizeof(struct TracerLaunch)};
    VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                       .setLayoutCount = 2,
                                       .pSetLayouts = layouts,
                                       .pushConstantRangeCount = 1,
                                       .pPushConstantRanges = &push};
    return gpu_check(vkCreatePipelineLayout(gpu->device, &info, NULL, &b->layout),
                     "vkCreatePipelineLayout");
}

static bool allocate_set(const struct gpu *gpu, bool has_scene, struct bindings *b)
{
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, TRACER_OWN_BUFFERS},
                                           {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1,
                                       .poolSizeCount = has_scene ? 2 : 1,
                                       .pPoolSizes = sizes};
    if (!gpu_check(vkCreateDescriptorPool(gpu->device, &pool, NULL, &b->pool),
                   "vkCreateDescriptorPool"))
        return false;
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = b->pool,
                                        .descriptorSetCount = 1,
                                        .pSetLayouts = &b->own_layout};
    return gpu_check(vkAllocateDescriptorSets(gpu->device, &info, &b->own_set),
                     "vkAllocateDescriptorSets");
}

static void write_buffers(const struct gpu *gpu, VkDescriptorSet set, const VkBuffer *buffers)
{
    VkDescriptorBufferInfo infos[TRACER_OWN_BUFFERS];
    for (uint32_t i = 0; i < TRACER_OWN_BUFFERS; i++)
        infos[i] = (VkDescriptorBufferInfo){buffers[i], 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set,
                                  .descriptorCount = TRACER_OWN_BUFFERS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = infos};
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
}

static void write_scene(const struct gpu *gpu, VkDescriptorSet set,
                        VkAccelerationStructureKHR scene)
{
    VkWriteDescriptorSetAccelerationStructureKHR structure = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR,
        .accelerationStructureCount = 1,
        .pAccelerationStructures = &scene};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .pNext = &structure,
                                  .dstSet = set,
                                  .dstBinding = TRACER_BINDING_SCENE,
                                  .descriptorCount = 1,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR};
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
}

bool bindings_create(const struct gpu *gpu, const struct bindings_request *request,
                     struct bindings *b)
{
    const bool has_scene = request->scene != VK_NULL_HANDLE;
    *b = (struct bindings){.stages = has_scene ? RAY_STAGES : VK_SHADER_STAGE_COMPUTE_BIT};
    if (!create_layouts(gpu, request, b) || !allocate_set(gpu, has_scene, b))
        return false;
    write_buffers(gpu, b->own_set, request->own_buffers);
    if (has_scene)
        write_scene(gpu, b->own_set, request->scene);
    return true;
}

void bindings_destroy(const struct gpu *gpu, struct bindings *b)
{
    vkDestroyDescriptorPool(gpu->device, b->pool, NULL);
    vkDestroyPipelineLayout(gpu->device, b->layout, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, b->own_layout, NULL);
    memset(b, 0, sizeof *b);
}

void bindings_bind(const struct bindings *b, VkCommandBuffer commands, VkPipelineBindPoint point,
                   VkDescriptorSet demand_set, const struct TracerLaunch *launch)
{
    const VkDescriptorSet sets[2] = {demand_set, b->own_set};
    vkCmdBindDescriptorSets(commands, point, b->layout, 0, 2, sets, 0, NULL);
    vkCmdPushConstants(commands, b->layout, b->stages, 0, sizeof *launch, launch);
}
