#include "vulkan_drawing.h"

#include "corridor.h"

#include "room_frag.h" /* SPIR-V */
#include "room_vert.h"

#define PUSH_STAGES (VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)

struct draw { /* push constants, as in room.vert and room.frag */
    uint32_t surface, table_index, frame;
    float aspect, eye_z;
};

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

void create_drawing(const struct gpu *gpu, const uint32_t size[2], VkDescriptorSetLayout set_layout,
                    bool paged, struct drawing *drawing)
{
    create_picture(gpu, size[0], size[1], &drawing->picture);
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = gpu->family};
    VK(vkCreateCommandPool(gpu->device, &pool, NULL, &drawing->command_pool));
    const VkPushConstantRange constants = {PUSH_STAGES, 0, sizeof(struct draw)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &set_layout,
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
    destroy_picture(gpu, &drawing->picture);
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
                   const uint32_t *table_indices, uint32_t frame, float eye_z)
{
    struct draw draw = {.frame = frame, .eye_z = eye_z};
    draw.aspect = (float)drawing->picture.width / (float)drawing->picture.height;
    begin_pass(commands, &drawing->picture);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing->layout, 0, 1, &set,
                            0, NULL);
    for (draw.surface = 0; draw.surface < SURFACES; draw.surface++) {
        draw.table_index = table_indices[texture_of_surface(draw.surface)];
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
