#include "traced_view.h"

#include "../../samples/demand-pbrt/pbrt_shared.h"
#include "../common/text.h"

#include "traced_view_comp.h"

#include <string.h>

#define GROUP 64u
#define ROW 1024u /* groups: 65536 pixels */

static bool create_layouts(struct traced_view *v, const SluiceDemandLoader *loader)
{
    VkDescriptorSetLayout layouts[2];
    VkDescriptorSetLayoutBinding bindings[2];
    for (uint32_t i = 0; i < 2; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                           .descriptorCount = 1,
                                           .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    const VkDescriptorSetLayoutCreateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings};
    const SluiceResult result = sluiceGetDemandDescriptorSetLayout(loader, &layouts[0]);
    if (result != SLUICE_SUCCESS) {
        text_say("sluiceGetDemandDescriptorSetLayout: %s", sluiceGetResultName(result));
        return false;
    }
    if (!gpu_check(vkCreateDescriptorSetLayout(v->gpu->device, &set, NULL, &v->set_layout),
                   "vkCreateDescriptorSetLayout"))
        return false;
    layouts[1] = v->set_layout;
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(uint32_t)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 2,
                                               .pSetLayouts = layouts,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &push};
    return gpu_check(vkCreatePipelineLayout(v->gpu->device, &layout, NULL, &v->layout),
                     "vkCreatePipelineLayout");
}

static bool create_set(struct traced_view *v)
{
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    if (!gpu_check(vkCreateDescriptorPool(v->gpu->device, &pool, NULL, &v->pool),
                   "vkCreateDescriptorPool"))
        return false;
    const VkDescriptorSetAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = v->pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &v->set_layout};
    return gpu_check(vkAllocateDescriptorSets(v->gpu->device, &info, &v->set),
                     "vkAllocateDescriptorSets");
}

bool traced_view_create(const struct gpu *gpu, const SluiceDemandLoader *loader,
                        struct traced_view *v)
{
    *v = (struct traced_view){.gpu = gpu};
    return create_layouts(v, loader) && create_set(v) &&
           gpu_create_compute_pipeline(gpu, v->layout, traced_view_comp, sizeof traced_view_comp,
                                       NULL, &v->pipeline);
}

void traced_view_destroy(struct traced_view *v)
{
    if (!v->gpu)
        return;
    gpu_destroy_buffer(v->gpu, &v->probes);
    gpu_destroy_buffer(v->gpu, &v->views);
    vkDestroyPipeline(v->gpu->device, v->pipeline, NULL);
    vkDestroyDescriptorPool(v->gpu->device, v->pool, NULL);
    vkDestroyPipelineLayout(v->gpu->device, v->layout, NULL);
    vkDestroyDescriptorSetLayout(v->gpu->device, v->set_layout, NULL);
    *v = (struct traced_view){0};
}

static void write_set(const struct traced_view *v)
{
    const VkDescriptorBufferInfo buffers[2] = {{v->probes.buffer, 0, VK_WHOLE_SIZE},
                                               {v->views.buffer, 0, VK_WHOLE_SIZE}};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = v->set,
                                        .descriptorCount = 2,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = buffers};
    vkUpdateDescriptorSets(v->gpu->device, 1, &write, 0, NULL);
}

bool traced_view_fit(struct traced_view *v, const struct film *film)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    gpu_destroy_buffer(v->gpu, &v->probes);
    gpu_destroy_buffer(v->gpu, &v->views);
    v->probes = v->views = (struct gpu_buffer){0};
    v->count = film->width * film->height;
    const size_t probes = v->count * sizeof(struct PbrtProbe);
    const size_t views = v->count * sizeof(struct TracedView);
    if (!gpu_create_buffer(v->gpu, probes, usage, &v->probes) ||
        !gpu_create_buffer(v->gpu, views, usage, &v->views))
        return false;
    memset(v->probes.mapped, 0xff, probes);
    memset(v->views.mapped, 0xff, views);
    write_set(v);
    return true;
}

static void wait_for(VkCommandBuffer commands, VkPipelineStageFlags from, VkPipelineStageFlags to,
                     VkAccessFlags reads)
{
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                     .dstAccessMask = reads};
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
}

void traced_view_record(const struct traced_view *v, VkCommandBuffer commands,
                        VkDescriptorSet demand_set)
{
    const VkDescriptorSet sets[2] = {demand_set, v->set};
    const uint32_t groups = (v->count + GROUP - 1) / GROUP;
    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    wait_for(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, compute,
             VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, v->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, v->layout, 0, 2, sets, 0,
                            NULL);
    vkCmdPushConstants(commands, v->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof v->count,
                       &v->count);
    vkCmdDispatch(commands, groups < ROW ? groups : ROW, (groups + ROW - 1) / ROW, 1);
    wait_for(commands, compute, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
             VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_HOST_READ_BIT);
}
