#include "vulkan/resolve.h"

#include <sluice/shared/resolve.h>

#include "resolve_feedback_comp.h"

static SluiceResult create_layouts(struct slc_resolve *r, const struct slc_vk *vk)
{
    VkDescriptorSetLayoutBinding bindings[2];
    for (uint32_t i = 0; i < 2; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                           .descriptorCount = 1,
                                           .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateDescriptorSetLayout(vk->device, &set_info, NULL, &r->set_layout),
        "vkCreateDescriptorSetLayout");
    if (result != SLUICE_SUCCESS)
        return result;
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct SluiceResolveParams)};
    VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                       .setLayoutCount = 1,
                                       .pSetLayouts = &r->set_layout,
                                       .pushConstantRangeCount = 1,
                                       .pPushConstantRanges = &push};
    return slc_vk_result(vk, vk->CreatePipelineLayout(vk->device, &info, NULL, &r->layout),
                         "vkCreatePipelineLayout");
}

static SluiceResult create_pipeline(struct slc_resolve *r, const struct slc_vk *vk)
{
    VkShaderModuleCreateInfo module_info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = sizeof resolve_feedback_comp,
                                            .pCode = resolve_feedback_comp};
    VkShaderModule module;
    SluiceResult result =
        slc_vk_result(vk, vk->CreateShaderModule(vk->device, &module_info, NULL, &module),
                      "vkCreateShaderModule");
    if (result != SLUICE_SUCCESS)
        return result;
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main"},
        .layout = r->layout};
    result = slc_vk_result(
        vk, vk->CreateComputePipelines(vk->device, VK_NULL_HANDLE, 1, &info, NULL, &r->pipeline),
        "vkCreateComputePipelines");
    vk->DestroyShaderModule(vk->device, module, NULL);
    return result;
}

static SluiceResult create_set(struct slc_resolve *r, const struct slc_vk *vk, VkBuffer feedback,
                               VkBuffer resolved)
{
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    VkDescriptorPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                            .maxSets = 1,
                                            .poolSizeCount = 1,
                                            .pPoolSizes = &size};
    SluiceResult result =
        slc_vk_result(vk, vk->CreateDescriptorPool(vk->device, &pool_info, NULL, &r->pool),
                      "vkCreateDescriptorPool");
    if (result != SLUICE_SUCCESS)
        return result;
    VkDescriptorSetAllocateInfo set_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = r->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &r->set_layout};
    result = slc_vk_result(vk, vk->AllocateDescriptorSets(vk->device, &set_info, &r->set),
                           "vkAllocateDescriptorSets");
    if (result != SLUICE_SUCCESS)
        return result;
    VkDescriptorBufferInfo buffers[2] = {{feedback, 0, VK_WHOLE_SIZE},
                                         {resolved, 0, VK_WHOLE_SIZE}};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = r->set,
                                  .descriptorCount = 2,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = buffers};
    vk->UpdateDescriptorSets(vk->device, 1, &write, 0, NULL);
    return SLUICE_SUCCESS;
}

SluiceResult slc_resolve_init(struct slc_resolve *resolve, const struct slc_vk *vk,
                              VkBuffer feedback, VkBuffer resolved)
{
    *resolve = (struct slc_resolve){0};
    SluiceResult result = create_layouts(resolve, vk);
    if (result == SLUICE_SUCCESS)
        result = create_pipeline(resolve, vk);
    if (result == SLUICE_SUCCESS)
        result = create_set(resolve, vk, feedback, resolved);
    return result;
}

void slc_resolve_finish(struct slc_resolve *resolve, const struct slc_vk *vk)
{
    if (resolve->set_layout) {
        vk->DestroyDescriptorPool(vk->device, resolve->pool, NULL);
        vk->DestroyPipeline(vk->device, resolve->pipeline, NULL);
        vk->DestroyPipelineLayout(vk->device, resolve->layout, NULL);
        vk->DestroyDescriptorSetLayout(vk->device, resolve->set_layout, NULL);
    }
    *resolve = (struct slc_resolve){0};
}

void slc_resolve_bind(const struct slc_resolve *resolve, const struct slc_vk *vk,
                      VkCommandBuffer commands)
{
    vk->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, resolve->pipeline);
    vk->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, resolve->layout, 0, 1,
                              &resolve->set, 0, NULL);
}

void slc_resolve_record(const struct slc_resolve *resolve, const struct slc_vk *vk,
                        VkCommandBuffer commands, uint32_t feedback_word, uint32_t region_count,
                        uint32_t resolved_word)
{
    struct SluiceResolveParams params = {feedback_word, region_count, resolved_word};
    vk->CmdPushConstants(commands, resolve->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof params,
                         &params);
    uint32_t words = (region_count + 3) / 4;
    vk->CmdDispatch(commands, (words + SLUICE_RESOLVE_GROUP_SIZE - 1) / SLUICE_RESOLVE_GROUP_SIZE,
                    1, 1);
}
