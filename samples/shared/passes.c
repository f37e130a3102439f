#include "passes.h"

#include "../common/draw_pipeline.h"

#include "reflections_comp.h" /* SPIR-V */
#include "room_frag.h"
#include "room_vert.h"

static const uint32_t texture_of[SURFACES] = {0, 1, 1, 2};

static bool create_layout(const struct gpu *gpu, VkDescriptorType type, VkDescriptorSetLayout *out)
{
    const VkDescriptorSetLayoutBinding binding = {
        0, type, 1, VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding};
    return gpu_check(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, out), "set layout");
}

static bool create_sets(struct passes *p)
{
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, TEXTURES},
                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = TEXTURES + 1,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    if (!create_layout(p->gpu, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, &p->texture_layout) ||
        !create_layout(p->gpu, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &p->buffer_layout) ||
        !gpu_check(vkCreateDescriptorPool(p->gpu->device, &pool, NULL, &p->pool), "pool"))
        return false;
    VkDescriptorSetLayout layouts[TEXTURES + 1] = {p->texture_layout, p->texture_layout,
                                                   p->texture_layout, p->buffer_layout};
    VkDescriptorSet sets[TEXTURES + 1];
    const VkDescriptorSetAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = p->pool,
                                              .descriptorSetCount = TEXTURES + 1,
                                              .pSetLayouts = layouts};
    if (!gpu_check(vkAllocateDescriptorSets(p->gpu->device, &info, sets), "sets"))
        return false;
    for (uint32_t i = 0; i < TEXTURES; i++)
        p->texture_sets[i] = sets[i];
    p->buffer_set = sets[TEXTURES];
    const VkDescriptorBufferInfo buffer = {p->reflections.buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = p->buffer_set,
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = &buffer};
    vkUpdateDescriptorSets(p->gpu->device, 1, &write, 0, NULL);
    return true;
}

void passes_set_image(struct passes *p, uint32_t texture, VkImageView view)
{
    const VkDescriptorImageInfo image = {p->sampler, view, VK_IMAGE_LAYOUT_GENERAL};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = p->texture_sets[texture],
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                        .pImageInfo = &image};
    vkUpdateDescriptorSets(p->gpu->device, 1, &write, 0, NULL);
}

static bool create_pipeline_layout(const struct gpu *gpu, VkDescriptorSetLayout first,
                                   VkDescriptorSetLayout second, VkPipelineLayout *out)
{
    const VkDescriptorSetLayout sets[2] = {first, second};
    const VkPushConstantRange range = {VK_SHADER_STAGE_ALL, 0, sizeof(struct draw)};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = 2,
                                             .pSetLayouts = sets,
                                             .pushConstantRangeCount = 1,
                                             .pPushConstantRanges = &range};
    return gpu_check(vkCreatePipelineLayout(gpu->device, &info, NULL, out), "pipeline layout");
}

static bool create_pipelines(struct passes *p)
{
    VkDevice device = p->gpu->device;
    VkShaderModule vertex = gpu_create_shader(p->gpu, room_vert, sizeof room_vert);
    VkShaderModule fragment = gpu_create_shader(p->gpu, room_frag, sizeof room_frag);
    const struct draw_pipeline_info room = {
        .target = &p->target, .layout = p->room_layout, .vertex = vertex, .fragment = fragment};
    bool created =
        vertex && fragment && draw_pipeline_create(p->gpu, &room, &p->room) &&
        gpu_create_compute_pipeline(p->gpu, p->reflections_layout, reflections_comp,
                                    sizeof reflections_comp, NULL, &p->reflections_pipeline);
    vkDestroyShaderModule(device, vertex, NULL);
    vkDestroyShaderModule(device, fragment, NULL);
    return created;
}

bool passes_create(struct passes *p, const struct gpu *gpu, uint32_t width, uint32_t height,
                   VkDescriptorSetLayout streamer_layout, VkDescriptorSetLayout loader_layout)
{
    const VkSamplerCreateInfo sampler = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                         .magFilter = VK_FILTER_LINEAR,
                                         .minFilter = VK_FILTER_LINEAR,
                                         .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                         .maxLod = VK_LOD_CLAMP_NONE};
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = gpu->command_pool,
        .commandBufferCount = 2};
    const VkDeviceSize size = (VkDeviceSize)width * height * 4;
    *p = (struct passes){.gpu = gpu};
    return target_create(gpu, width, height, 1, &p->target) &&
           gpu_create_buffer(gpu, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, &p->picture) &&
           gpu_create_buffer(gpu, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &p->reflections) &&
           gpu_check(vkCreateSampler(gpu->device, &sampler, NULL, &p->sampler), "sampler") &&
           create_sets(p) &&
           create_pipeline_layout(gpu, streamer_layout, p->texture_layout, &p->room_layout) &&
           create_pipeline_layout(gpu, loader_layout, p->buffer_layout, &p->reflections_layout) &&
           create_pipelines(p) &&
           gpu_check(vkAllocateCommandBuffers(gpu->device, &commands, p->commands), "commands");
}

void passes_destroy(struct passes *p)
{
    if (!p->gpu)
        return;
    VkDevice device = p->gpu->device;
    vkDestroyPipeline(device, p->room, NULL);
    vkDestroyPipeline(device, p->reflections_pipeline, NULL);
    vkDestroyPipelineLayout(device, p->room_layout, NULL);
    vkDestroyPipelineLayout(device, p->reflections_layout, NULL);
    vkDestroyDescriptorPool(device, p->pool, NULL);
    vkDestroyDescriptorSetLayout(device, p->texture_layout, NULL);
    vkDestroyDescriptorSetLayout(device, p->buffer_layout, NULL);
    vkDestroySampler(device, p->sampler, NULL);
    gpu_destroy_buffer(p->gpu, &p->picture);
    gpu_destroy_buffer(p->gpu, &p->reflections);
    target_destroy(p->gpu, &p->target);
}

static struct draw draw_of(const struct passes *p)
{
    return (struct draw){.width = p->target.width, .height = p->target.height};
}

void passes_record_room(const struct passes *p, VkDescriptorSet set,
                        const uint32_t tables[TEXTURES])
{
    const float sky[4] = {0.45f, 0.6f, 0.8f, 1};
    VkCommandBuffer commands = p->commands[0];
    target_begin(&p->target, commands, sky);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p->room);
    for (uint32_t surface = 0; surface < SURFACES; surface++) {
        const VkDescriptorSet sets[2] = {set, p->texture_sets[texture_of[surface]]};
        struct draw draw = draw_of(p);
        draw.surface = surface;
        draw.table_index = tables[texture_of[surface]];
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p->room_layout, 0, 2,
                                sets, 0, NULL);
        vkCmdPushConstants(commands, p->room_layout, VK_SHADER_STAGE_ALL, 0, sizeof draw, &draw);
        vkCmdDraw(commands, 6, 1, 0, 0);
    }
    target_end(&p->target, commands);
}

void passes_record_reflections(const struct passes *p, VkDescriptorSet set,
                               const uint32_t ids[TEXTURES])
{
    const VkDescriptorSet sets[2] = {set, p->buffer_set};
    VkCommandBuffer commands = p->commands[1];
    struct draw draw = draw_of(p);
    for (uint32_t i = 0; i < SURFACES; i++)
        draw.textures[i] = ids[texture_of[i]];
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->reflections_pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->reflections_layout, 0, 2,
                            sets, 0, NULL);
    vkCmdPushConstants(commands, p->reflections_layout, VK_SHADER_STAGE_ALL, 0, sizeof draw, &draw);
    vkCmdDispatch(commands, (draw.width + 7) / 8, (draw.height + 7) / 8, 1);
    gpu_barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}
