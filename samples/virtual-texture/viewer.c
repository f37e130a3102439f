#include "viewer.h"

#include "view_comp.h"

static bool create_set(struct viewer *v)
{
    VkDevice device = v->gpu->device;
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL}};
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings};
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    if (!gpu_check(vkCreateDescriptorSetLayout(device, &layout, NULL, &v->set_layout), "layout") ||
        !gpu_check(vkCreateDescriptorPool(device, &pool, NULL, &v->pool), "pool"))
        return false;
    const VkDescriptorSetAllocateInfo set = {.sType =
                                                 VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = v->pool,
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &v->set_layout};
    if (!gpu_check(vkAllocateDescriptorSets(device, &set, &v->set), "set"))
        return false;
    const VkDescriptorBufferInfo buffers[] = {{v->pixels.buffer, 0, VK_WHOLE_SIZE},
                                              {v->counts.buffer, 0, VK_WHOLE_SIZE}};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = v->set,
                                        .descriptorCount = 2,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = buffers};
    vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
    return true;
}

static bool create_pipeline(struct viewer *v, VkDescriptorSetLayout streamer_layout)
{
    VkDevice device = v->gpu->device;
    const VkDescriptorSetLayout sets[2] = {streamer_layout, v->set_layout};
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct FractalView)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 2,
                                               .pSetLayouts = sets,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    if (!gpu_check(vkCreatePipelineLayout(device, &layout, NULL, &v->layout), "layout"))
        return false;
    return gpu_create_compute_pipeline(v->gpu, v->layout, view_comp, sizeof view_comp, NULL,
                                       &v->pipeline);
}

bool viewer_create(struct viewer *v, const struct gpu *gpu, uint32_t width, uint32_t height,
                   VkDescriptorSetLayout streamer_layout)
{
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = gpu->command_pool,
        .commandBufferCount = 1};
    *v = (struct viewer){.gpu = gpu, .width = width, .height = height};
    return gpu_create_buffer(gpu, (VkDeviceSize)width * height * 4,
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &v->pixels) &&
           gpu_create_buffer(gpu, sizeof(struct FractalCounts), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                             &v->counts) &&
           create_set(v) && create_pipeline(v, streamer_layout) &&
           gpu_check(vkAllocateCommandBuffers(gpu->device, &commands, &v->commands), "commands");
}

void viewer_destroy(struct viewer *v)
{
    if (!v->gpu)
        return;
    VkDevice device = v->gpu->device;
    vkDestroyPipeline(device, v->pipeline, NULL);
    vkDestroyPipelineLayout(device, v->layout, NULL);
    vkDestroyDescriptorPool(device, v->pool, NULL);
    vkDestroyDescriptorSetLayout(device, v->set_layout, NULL);
    gpu_destroy_buffer(v->gpu, &v->pixels);
    gpu_destroy_buffer(v->gpu, &v->counts);
}

void viewer_record(const struct viewer *v, VkDescriptorSet frame_set,
                   const struct FractalView *view)
{
    const VkDescriptorSet sets[2] = {frame_set, v->set};
    vkCmdBindPipeline(v->commands, VK_PIPELINE_BIND_POINT_COMPUTE, v->pipeline);
    vkCmdBindDescriptorSets(v->commands, VK_PIPELINE_BIND_POINT_COMPUTE, v->layout, 0, 2, sets, 0,
                            NULL);
    vkCmdPushConstants(v->commands, v->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof *view, view);
    vkCmdDispatch(v->commands, (v->width + FRACTAL_GROUP - 1) / FRACTAL_GROUP,
                  (v->height + FRACTAL_GROUP - 1) / FRACTAL_GROUP, 1);
    gpu_barrier(v->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}
