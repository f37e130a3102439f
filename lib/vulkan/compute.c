#include "vulkan/compute.h"

#include <assert.h>

static SluiceResult create_layouts(struct slc_compute *c, const struct slc_vk *vk)
{
    VkDescriptorSetLayoutBinding bindings[SLC_COMPUTE_BINDINGS];
    for (uint32_t i = 0; i < c->binding_count; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                           .descriptorCount = 1,
                                           .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = c->binding_count,
        .pBindings = bindings};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateDescriptorSetLayout(vk->device, &set_info, NULL, &c->set_layout),
        "vkCreateDescriptorSetLayout");
    if (result != SLUICE_SUCCESS)
        return result;
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, c->push_size};
    VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                       .setLayoutCount = 1,
                                       .pSetLayouts = &c->set_layout,
                                       .pushConstantRangeCount = 1,
                                       .pPushConstantRanges = &push};
    return slc_vk_result(vk, vk->CreatePipelineLayout(vk->device, &info, NULL, &c->layout),
                         "vkCreatePipelineLayout");
}

static SluiceResult create_pipeline(const struct slc_compute *c, const struct slc_vk *vk,
                                    const struct slc_compute_pass *pass, VkPipeline *pipeline)
{
    VkShaderModuleCreateInfo module_info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = pass->size,
                                            .pCode = pass->code};
    VkShaderModule module;
    SluiceResult result =
        slc_vk_result(vk, vk->CreateShaderModule(vk->device, &module_info, NULL, &module),
                      "vkCreateShaderModule");
    if (result != SLUICE_SUCCESS)
        return result;
    const size_t size = sizeof pass->constants[0];
    const VkSpecializationMapEntry entries[2] = {{0, 0, size}, {1, (uint32_t)size, size}};
    VkSpecializationInfo specialization = {2, entries, 2 * size, pass->constants};
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = c->layout};
    result = slc_vk_result(
        vk, vk->CreateComputePipelines(vk->device, vk->pipeline_cache, 1, &info, NULL, pipeline),
        "vkCreateComputePipelines");
    vk->DestroyShaderModule(vk->device, module, NULL);
    return result;
}

static SluiceResult create_sets(struct slc_compute *c, const struct slc_vk *vk, uint32_t count)
{
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, c->binding_count * count};
    VkDescriptorPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                            .maxSets = count,
                                            .poolSizeCount = 1,
                                            .pPoolSizes = &size};
    SluiceResult result =
        slc_vk_result(vk, vk->CreateDescriptorPool(vk->device, &pool_info, NULL, &c->pool),
                      "vkCreateDescriptorPool");
    if (result != SLUICE_SUCCESS)
        return result;
    VkDescriptorSetLayout layouts[SLC_COMPUTE_SETS];
    for (uint32_t i = 0; i < count; i++)
        layouts[i] = c->set_layout;
    VkDescriptorSetAllocateInfo set_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = c->pool,
                                            .descriptorSetCount = count,
                                            .pSetLayouts = layouts};
    return slc_vk_result(vk, vk->AllocateDescriptorSets(vk->device, &set_info, c->sets),
                         "vkAllocateDescriptorSets");
}

SluiceResult slc_compute_init(struct slc_compute *compute, const struct slc_vk *vk,
                              const struct slc_compute_create_info *info)
{
    assert(info->binding_count <= SLC_COMPUTE_BINDINGS && info->pass_count <= SLC_COMPUTE_PASSES &&
           info->set_count <= SLC_COMPUTE_SETS);
    *compute =
        (struct slc_compute){.binding_count = info->binding_count, .push_size = info->push_size};
    SluiceResult result = create_layouts(compute, vk);
    for (uint32_t i = 0; i < info->pass_count && result == SLUICE_SUCCESS; i++) {
        result = create_pipeline(compute, vk, &info->passes[i], &compute->pipelines[i]);
        if (result == SLUICE_SUCCESS)
            slc_vk_name(vk, VK_OBJECT_TYPE_PIPELINE, (uint64_t)compute->pipelines[i], info->name);
    }
    if (result == SLUICE_SUCCESS)
        result = create_sets(compute, vk, info->set_count);
    return result;
}

void slc_compute_finish(struct slc_compute *compute, const struct slc_vk *vk)
{
    if (compute->set_layout) {
        vk->DestroyDescriptorPool(vk->device, compute->pool, NULL);
        for (uint32_t i = 0; i < SLC_COMPUTE_PASSES; i++)
            vk->DestroyPipeline(vk->device, compute->pipelines[i], NULL);
        vk->DestroyPipelineLayout(vk->device, compute->layout, NULL);
        vk->DestroyDescriptorSetLayout(vk->device, compute->set_layout, NULL);
    }
    *compute = (struct slc_compute){0};
}

void slc_compute_set_buffers(struct slc_compute *compute, const struct slc_vk *vk, uint32_t set,
                             const VkBuffer *buffers)
{
    VkDescriptorBufferInfo infos[SLC_COMPUTE_BINDINGS];
    for (uint32_t i = 0; i < compute->binding_count; i++)
        infos[i] = (VkDescriptorBufferInfo){buffers[i], 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = compute->sets[set],
                                  .descriptorCount = compute->binding_count,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = infos};
    vk->UpdateDescriptorSets(vk->device, 1, &write, 0, NULL);
}

void slc_compute_bind(const struct slc_compute *compute, const struct slc_vk *vk,
                      VkCommandBuffer commands, uint32_t set, const void *push)
{
    vk->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute->layout, 0, 1,
                              &compute->sets[set], 0, NULL);
    vk->CmdPushConstants(commands, compute->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                         compute->push_size, push);
}

void slc_compute_dispatch(const struct slc_compute *compute, const struct slc_vk *vk,
                          VkCommandBuffer commands, uint32_t pass, uint32_t x, uint32_t y)
{
    vk->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute->pipelines[pass]);
    vk->CmdDispatch(commands, x, y, 1);
}

uint32_t slc_compute_group_size(const struct slc_vk *vk, uint32_t wanted)
{
    VkPhysicalDeviceProperties2 properties = {.sType =
                                                  VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk->GetPhysicalDeviceProperties2(vk->physical_device, &properties);
    const VkPhysicalDeviceLimits *limits = &properties.properties.limits;
    uint32_t size = wanted;
    while (size > 128 && /* every device supports 128 */
           (size > limits->maxComputeWorkGroupInvocations ||
            size > limits->maxComputeWorkGroupSize[0]))
        size /= 2;
    return size;
}

void slc_compute_barrier(const struct slc_vk *vk, VkCommandBuffer commands,
                         VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
                         VkAccessFlags used)
{
    VkMemoryBarrier memory = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = written, .dstAccessMask = used};
    vk->CmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, NULL, 0, NULL);
}
