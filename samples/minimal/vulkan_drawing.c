#include "vulkan_drawing.h"

#include "corridor.h"

#include "room_frag.h" /* SPIR-V */
#include "room_vert.h"

#define PUSH_STAGES (VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)

struct draw { /* push constants, as in room.vert and room.frag */
    uint32_t surface, table_index, frame;
    float aspect, eye_z;
};

static VkDescriptorSetLayout create_set_layout(const struct gpu *gpu, uint32_t binding_count,
                                               const VkDescriptorSetLayoutBinding *bindings)
{
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = binding_count,
                                            .pBindings = bindings};
    VkDescriptorSetLayout layout;
    VK(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, &layout));
    return layout;
}

static VkPipelineShaderStageCreateInfo
create_stage(const struct gpu *gpu, VkShaderStageFlagBits flags, const uint32_t *words, size_t size)
{
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = words};
    VkPipelineShaderStageCreateInfo stage = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = flags,
        .pName = "main"};
    VK(vkCreateShaderModule(gpu->device, &info, NULL, &stage.module));
    return stage;
}

static VkPipeline create_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                  const struct picture *target, VkBool32 paged)
{
    VkPipelineShaderStageCreateInfo stages[2] = {
        create_stage(gpu, VK_SHADER_STAGE_VERTEX_BIT, room_vert, sizeof room_vert),
        create_stage(gpu, VK_SHADER_STAGE_FRAGMENT_BIT, room_frag, sizeof room_frag)};
    const VkSpecializationMapEntry constant = {0, 0, sizeof paged};
    const VkSpecializationInfo constants = {1, &constant, sizeof paged, &paged};
    stages[1].pSpecializationInfo = &constants;
    VkPipelineVertexInputStateCreateInfo vertices = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkViewport viewport = {0, 0, (float)target->width, (float)target->height, 0, 1};
    VkRect2D scissor = {.extent = {target->width, target->height}};
    VkPipelineViewportStateCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor};
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1.0f};
    VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineColorBlendAttachmentState attachment = {.colorWriteMask = 0xf};
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &vertices,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &view,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .pColorBlendState = &blend,
                                         .layout = layout,
                                         .renderPass = target->render_pass};
    VkPipeline pipeline;
    VK(vkCreateGraphicsPipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline));
    for (int i = 0; i < 2; i++)
        vkDestroyShaderModule(gpu->device, stages[i].module, NULL);
    return pipeline;
}

static void create_set_layouts(const struct gpu *gpu, VkDescriptorSetLayout layouts[2])
{
    VkDescriptorSetLayoutBinding bindings[5]; /* as room.frag has them */
    for (uint32_t i = 0; i < 4; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                     VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    bindings[4] = (VkDescriptorSetLayoutBinding){4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                 PAGE_CHUNKS, VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    layouts[0] = create_set_layout(gpu, 5, bindings);
    const VkDescriptorSetLayoutBinding albedo = {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                                 VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    layouts[1] = create_set_layout(gpu, 1, &albedo);
}

/* What sample.glsl asks of a sampler: no bias of its own, all levels, the texture's address modes.
 */
static VkSampler create_sampler(const struct gpu *gpu)
{
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_LINEAR,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .maxLod = VK_LOD_CLAMP_NONE};
    VkSampler sampler;
    VK(vkCreateSampler(gpu->device, &info, NULL, &sampler));
    return sampler;
}

static void create_pools(const struct gpu *gpu, struct drawing *drawing)
{
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 64},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 64}};
    VkDescriptorPoolCreateInfo set_pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                           .maxSets = 16,
                                           .poolSizeCount = 2,
                                           .pPoolSizes = sizes};
    VK(vkCreateDescriptorPool(gpu->device, &set_pool, NULL, &drawing->set_pool));
    VkCommandPoolCreateInfo command_pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .flags =
                                                VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                            .queueFamilyIndex = gpu->family};
    VK(vkCreateCommandPool(gpu->device, &command_pool, NULL, &drawing->command_pool));
}

void create_drawing(const struct gpu *gpu, const uint32_t size[2], bool paged,
                    struct drawing *drawing)
{
    create_picture(gpu, size[0], size[1], &drawing->picture);
    create_set_layouts(gpu, drawing->set_layouts);
    create_pools(gpu, drawing);
    drawing->sampler = create_sampler(gpu);
    const VkPushConstantRange constants = {PUSH_STAGES, 0, sizeof(struct draw)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 2,
                                         .pSetLayouts = drawing->set_layouts,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &constants};
    VK(vkCreatePipelineLayout(gpu->device, &layout, NULL, &drawing->layout));
    drawing->pipeline = create_pipeline(gpu, drawing->layout, &drawing->picture, paged);
}

void destroy_drawing(const struct gpu *gpu, const struct drawing *drawing)
{
    vkDestroyCommandPool(gpu->device, drawing->command_pool, NULL);
    vkDestroyPipeline(gpu->device, drawing->pipeline, NULL);
    vkDestroyPipelineLayout(gpu->device, drawing->layout, NULL);
    vkDestroySampler(gpu->device, drawing->sampler, NULL);
    vkDestroyDescriptorPool(gpu->device, drawing->set_pool, NULL);
    for (int i = 0; i < 2; i++)
        vkDestroyDescriptorSetLayout(gpu->device, drawing->set_layouts[i], NULL);
    destroy_picture(gpu, &drawing->picture);
}

VkDescriptorSet allocate_set(const struct gpu *gpu, const struct drawing *drawing, uint32_t index)
{
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = drawing->set_pool,
                                        .descriptorSetCount = 1,
                                        .pSetLayouts = &drawing->set_layouts[index]};
    VkDescriptorSet set;
    VK(vkAllocateDescriptorSets(gpu->device, &info, &set));
    return set;
}

void write_buffers(const struct gpu *gpu, VkDescriptorSet set, uint32_t count,
                   const VkBuffer *buffers)
{
    for (uint32_t i = 0; i < count; i++) {
        const VkDescriptorBufferInfo buffer = {buffers[i], 0, VK_WHOLE_SIZE};
        const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                            .pBufferInfo = &buffer};
        vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
    }
}

void write_images(const struct gpu *gpu, VkDescriptorSet set, uint32_t binding, uint32_t count,
                  const VkImageView *views, VkSampler sampler)
{
    for (uint32_t i = 0; i < count; i++) {
        const VkDescriptorImageInfo image = {sampler, views[i], VK_IMAGE_LAYOUT_GENERAL};
        const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = binding,
                                            .dstArrayElement = i,
                                            .descriptorCount = 1,
                                            .descriptorType =
                                                VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                            .pImageInfo = &image};
        vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
    }
}

VkCommandBuffer allocate_commands(const struct gpu *gpu, const struct drawing *drawing)
{
    VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                        .commandPool = drawing->command_pool,
                                        .commandBufferCount = 1};
    VkCommandBuffer commands;
    VK(vkAllocateCommandBuffers(gpu->device, &info, &commands));
    return commands;
}

void begin_commands(VkCommandBuffer commands)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VK(vkBeginCommandBuffer(commands, &info));
}

static void begin_pass(VkCommandBuffer commands, const struct picture *picture)
{
    const VkClearValue sky = {.color = {.float32 = {0.30f, 0.45f, 0.65f, 1.0f}}};
    const VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = picture->render_pass,
                                        .framebuffer = picture->framebuffer,
                                        .renderArea = {.extent = {picture->width, picture->height}},
                                        .clearValueCount = 1,
                                        .pClearValues = &sky};
    vkCmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
}

void draw_corridor(VkCommandBuffer commands, const struct drawing *drawing, VkDescriptorSet set,
                   const struct drawn_texture *textures, uint32_t frame, float eye_z)
{
    struct draw draw = {.frame = frame, .eye_z = eye_z};
    draw.aspect = (float)drawing->picture.width / (float)drawing->picture.height;
    begin_pass(commands, &drawing->picture);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing->pipeline);
    for (draw.surface = 0; draw.surface < SURFACES; draw.surface++) {
        const struct drawn_texture *texture = &textures[texture_of_surface(draw.surface)];
        const VkDescriptorSet sets[] = {set, texture->set};
        draw.table_index = texture->table_index;
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing->layout, 0, 2,
                                sets, 0, NULL);
        vkCmdPushConstants(commands, drawing->layout, PUSH_STAGES, 0, sizeof draw, &draw);
        vkCmdDraw(commands, 6, 1, 0, 0);
    }
    vkCmdEndRenderPass(commands);
}

void submit(const struct gpu *gpu, VkCommandBuffer commands, VkSemaphore semaphore, uint64_t value)
{
    const VkTimelineSemaphoreSubmitInfo values = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &value};
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = &values,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &commands,
                               .signalSemaphoreCount = 1,
                               .pSignalSemaphores = &semaphore};
    VK(vkEndCommandBuffer(commands));
    VK(vkQueueSubmit(gpu->queue, 1, &info, VK_NULL_HANDLE));
}

void wait_for(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value)
{
    const VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &semaphore,
                                      .pValues = &value};
    if (semaphore)
        VK(vkWaitSemaphores(gpu->device, &info, UINT64_MAX));
}
