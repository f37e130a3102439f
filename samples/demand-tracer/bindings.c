#include "bindings.h"

#include <string.h>

#define RAY_STAGES                                                                                 \
    (VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR |                               \
     VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR)

static bool create_set_layout(const struct gpu *gpu, uint32_t buffer_count,
                              VkDescriptorType last_type, uint32_t last_count,
                              VkShaderStageFlags stages, VkDescriptorSetLayout *layout)
{
    VkDescriptorSetLayoutBinding bindings[TRACER_OWN_BUFFERS + 1];
    for (uint32_t i = 0; i < buffer_count; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                           .descriptorCount = 1,
                                           .stageFlags = stages};
    bindings[buffer_count] = (VkDescriptorSetLayoutBinding){.binding = buffer_count,
                                                            .descriptorType = last_type,
                                                            .descriptorCount = last_count,
                                                            .stageFlags = stages};
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = buffer_count + (last_count > 0),
                                            .pBindings = bindings};
    return gpu_check(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, layout),
                     "vkCreateDescriptorSetLayout");
}

static bool create_layouts(const struct gpu *gpu, bool has_scene, struct bindings *b)
{
    VkPushConstantRange push = {b->stages, 0, sizeof(struct TracerLaunch)};
    VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                       .setLayoutCount = 2,
                                       .pSetLayouts = b->layouts,
                                       .pushConstantRangeCount = 1,
                                       .pPushConstantRanges = &push};
    return create_set_layout(gpu, TRACER_DEMAND_BUFFERS, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                             TRACER_PAGE_CHUNKS, b->stages, &b->layouts[0]) &&
           create_set_layout(gpu, TRACER_OWN_BUFFERS, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
                             has_scene ? 1 : 0, b->stages, &b->layouts[1]) &&
           gpu_check(vkCreatePipelineLayout(gpu->device, &info, NULL, &b->layout),
                     "vkCreatePipelineLayout");
}

static bool allocate_sets(const struct gpu *gpu, bool has_scene, struct bindings *b)
{
    const VkDescriptorPoolSize sizes[3] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, TRACER_DEMAND_BUFFERS + TRACER_OWN_BUFFERS},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, TRACER_PAGE_CHUNKS},
        {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 2,
                                       .poolSizeCount = has_scene ? 3 : 2,
                                       .pPoolSizes = sizes};
    if (!gpu_check(vkCreateDescriptorPool(gpu->device, &pool, NULL, &b->pool),
                   "vkCreateDescriptorPool"))
        return false;
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = b->pool,
                                        .descriptorSetCount = 2,
                                        .pSetLayouts = b->layouts};
    return gpu_check(vkAllocateDescriptorSets(gpu->device, &info, b->sets),
                     "vkAllocateDescriptorSets");
}

static void write_buffers(const struct gpu *gpu, VkDescriptorSet set, const VkBuffer *buffers,
                          uint32_t count)
{
    VkDescriptorBufferInfo infos[TRACER_OWN_BUFFERS];
    for (uint32_t i = 0; i < count; i++)
        infos[i] = (VkDescriptorBufferInfo){buffers[i], 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set,
                                  .descriptorCount = count,
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

void bindings_follow_pages(const struct gpu *gpu, const SluiceDemandLoader *loader,
                           struct bindings *b)
{
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetDemandPages(loader, &pages);
    if (pages.generation == b->page_generation)
        return;
    b->page_generation = pages.generation;
    VkDescriptorImageInfo infos[TRACER_PAGE_CHUNKS];
    for (uint32_t i = 0; i < TRACER_PAGE_CHUNKS; i++)
        infos[i] = (VkDescriptorImageInfo){pages.sampler, pages.pViews[i], VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = b->sets[0],
                                  .dstBinding = TRACER_BINDING_PAGES,
                                  .descriptorCount = TRACER_PAGE_CHUNKS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                  .pImageInfo = infos};
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
}

bool bindings_create(const struct gpu *gpu, const struct bindings_request *request,
                     struct bindings *b)
{
    const bool has_scene = request->scene != VK_NULL_HANDLE;
    *b = (struct bindings){.stages = has_scene ? RAY_STAGES : VK_SHADER_STAGE_COMPUTE_BIT};
    if (!create_layouts(gpu, has_scene, b) || !allocate_sets(gpu, has_scene, b))
        return false;
    SluiceDemandBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetDemandBuffers(request->loader, &buffers);
    const VkBuffer demand[TRACER_DEMAND_BUFFERS] = {
        buffers.textures, buffers.levels,   buffers.directory, buffers.blocks,
        buffers.masks,    buffers.requests, buffers.sections};
    write_buffers(gpu, b->sets[0], demand, TRACER_DEMAND_BUFFERS);
    write_buffers(gpu, b->sets[1], request->own_buffers, TRACER_OWN_BUFFERS);
    if (has_scene)
        write_scene(gpu, b->sets[1], request->scene);
    return true;
}

void bindings_destroy(const struct gpu *gpu, struct bindings *b)
{
    vkDestroyDescriptorPool(gpu->device, b->pool, NULL);
    vkDestroyPipelineLayout(gpu->device, b->layout, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, b->layouts[0], NULL);
    vkDestroyDescriptorSetLayout(gpu->device, b->layouts[1], NULL);
    memset(b, 0, sizeof *b);
}

void bindings_bind(const struct bindings *b, VkCommandBuffer commands, VkPipelineBindPoint point,
                   const struct TracerLaunch *launch)
{
    vkCmdBindDescriptorSets(commands, point, b->layout, 0, 2, b->sets, 0, NULL);
    vkCmdPushConstants(commands, b->layout, b->stages, 0, sizeof *launch, launch);
}
