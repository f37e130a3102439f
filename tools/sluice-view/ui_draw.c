#include "ui_draw.h"

#include "../../samples/common/one_time.h"
#include "ui_texels.h"

#include "ui_frag.h"
#include "ui_vert.h"

#include <stddef.h>
#include <string.h>

struct push {
    float scale[2];
    uint32_t mode;
};

static bool create_layouts(struct ui_drawing *d)
{
    VkDevice device = d->gpu->device;
    const VkSamplerCreateInfo sampler = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                         .magFilter = VK_FILTER_LINEAR,
                                         .minFilter = VK_FILTER_LINEAR,
                                         .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                         .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                         .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    if (!gpu_check(vkCreateSampler(device, &sampler, NULL, &d->sampler), "vkCreateSampler"))
        return false;
    const VkDescriptorSetLayoutBinding binding = {.descriptorType =
                                                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                  .descriptorCount = 1,
                                                  .stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT,
                                                  .pImmutableSamplers = &d->sampler};
    const VkDescriptorSetLayoutCreateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding};
    if (!gpu_check(vkCreateDescriptorSetLayout(device, &set, NULL, &d->set_layout),
                   "vkCreateDescriptorSetLayout"))
        return false;
    const VkDescriptorSetLayout sets[] = {d->set_layout, d->set_layout};
    const VkPushConstantRange range = {.stageFlags = VK_SHADER_STAGE_VERTEX_BIT |
                                                     VK_SHADER_STAGE_FRAGMENT_BIT,
                                       .size = sizeof(struct push)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 2,
                                               .pSetLayouts = sets,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    return gpu_check(vkCreatePipelineLayout(device, &layout, NULL, &d->layout),
                     "vkCreatePipelineLayout");
}

static bool create_pipeline_of(struct ui_drawing *d, VkRenderPass pass, VkShaderModule vertex,
                               VkShaderModule fragment)
{
    const VkPipelineShaderStageCreateInfo stages[] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main"}};
    const VkVertexInputBindingDescription binding = {0, sizeof(struct ui_vertex),
                                                     VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attributes[] = {
        {0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct ui_vertex, x)},
        {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct ui_vertex, u)},
        {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(struct ui_vertex, color)}};
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = 1,
        .pVertexBindingDescriptions = &binding,
        .vertexAttributeDescriptionCount = 3,
        .pVertexAttributeDescriptions = attributes};
    const VkPipelineInputAssemblyStateCreateInfo triangles = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    const VkPipelineColorBlendAttachmentState over = {
        .blendEnable = VK_TRUE,
        .srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA,
        .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .colorWriteMask = 0xF};
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &over};
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = states};
    const VkGraphicsPipelineCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .stageCount = 2,
        .pStages = stages,
        .pVertexInputState = &input,
        .pInputAssemblyState = &triangles,
        .pViewportState = &viewport,
        .pRasterizationState = &raster,
        .pMultisampleState = &samples,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic,
        .layout = d->layout,
        .renderPass = pass};
    return gpu_check(
        vkCreateGraphicsPipelines(d->gpu->device, VK_NULL_HANDLE, 1, &create, NULL, &d->pipeline),
        "vkCreateGraphicsPipelines");
}

static bool create_pipeline(struct ui_drawing *d, VkRenderPass pass)
{
    VkShaderModule vertex = gpu_create_shader(d->gpu, ui_vert, sizeof ui_vert);
    VkShaderModule fragment = gpu_create_shader(d->gpu, ui_frag, sizeof ui_frag);
    bool created = vertex && fragment && create_pipeline_of(d, pass, vertex, fragment);
    vkDestroyShaderModule(d->gpu->device, vertex, NULL);
    vkDestroyShaderModule(d->gpu->device, fragment, NULL);
    return created;
}

struct font_upload {
    VkImage image;
    VkBuffer buffer;
    uint32_t width, height;
};

static void record_font(void *user_data, VkCommandBuffer commands)
{
    const struct font_upload *upload = user_data;
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {upload->width, upload->height, 1}};
    ui_texels_record_layout(commands, upload->image, true);
    vkCmdCopyBufferToImage(commands, upload->buffer, upload->image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    ui_texels_record_layout(commands, upload->image, false);
}

static bool create_font(struct ui_drawing *d, const uint8_t *texels, uint32_t width,
                        uint32_t height)
{
    struct gpu_buffer staging = {0};
    const size_t size = (size_t)width * height * 4;
    if (!gpu_create_texture(d->gpu, VK_FORMAT_R8G8B8A8_UNORM, width, height, 1, &d->font) ||
        !gpu_create_buffer(d->gpu, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, &staging))
        return false;
    memcpy(staging.mapped, texels, size);
    struct font_upload upload = {d->font.image, staging.buffer, width, height};
    bool done = one_time_run(d->gpu, record_font, &upload);
    gpu_destroy_buffer(d->gpu, &staging);
    return done;
}

static bool create_sets(struct ui_drawing *d)
{
    const uint32_t count = UI_DRAW_SLOTS * UI_TEXTURE_COUNT;
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = count,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    if (!gpu_check(vkCreateDescriptorPool(d->gpu->device, &pool, NULL, &d->pool),
                   "vkCreateDescriptorPool"))
        return false;
    VkDescriptorSetLayout layouts[UI_TEXTURE_COUNT];
    for (int i = 0; i < UI_TEXTURE_COUNT; i++)
        layouts[i] = d->set_layout;
    const VkDescriptorSetAllocateInfo sets = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = d->pool,
                                              .descriptorSetCount = UI_TEXTURE_COUNT,
                                              .pSetLayouts = layouts};
    for (int i = 0; i < UI_DRAW_SLOTS; i++)
        if (!gpu_check(vkAllocateDescriptorSets(d->gpu->device, &sets, d->slots[i].sets),
                       "vkAllocateDescriptorSets"))
            return false;
    return true;
}

bool ui_drawing_create(const struct gpu *gpu, const struct target *target, const uint8_t *font,
                       uint32_t font_width, uint32_t font_height, struct ui_drawing *drawing)
{
    *drawing = (struct ui_drawing){.gpu = gpu};
    if (create_layouts(drawing) && create_pipeline(drawing, target->pass) &&
        create_font(drawing, font, font_width, font_height) && create_sets(drawing))
        return true;
    ui_drawing_destroy(drawing);
    return false;
}

void ui_drawing_destroy(struct ui_drawing *d)
{
    if (!d->gpu)
        return;
    for (int i = 0; i < UI_DRAW_SLOTS; i++) {
        gpu_destroy_buffer(d->gpu, &d->slots[i].vertices);
        gpu_destroy_buffer(d->gpu, &d->slots[i].indices);
    }
    gpu_destroy_image(d->gpu, &d->font);
    vkDestroyDescriptorPool(d->gpu->device, d->pool, NULL);
    vkDestroyPipeline(d->gpu->device, d->pipeline, NULL);
    vkDestroyPipelineLayout(d->gpu->device, d->layout, NULL);
    vkDestroyDescriptorSetLayout(d->gpu->device, d->set_layout, NULL);
    vkDestroySampler(d->gpu->device, d->sampler, NULL);
    *d = (struct ui_drawing){0};
}

/* In every frame: a new view may have the handle of one that was destroyed. */
static void show(struct ui_drawing *d, struct ui_draw_slot *slot, uint32_t texture,
                 VkImageView view)
{
    const VkDescriptorImageInfo image = {.imageView = view,
                                         .imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = slot->sets[texture],
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                        .pImageInfo = &image};
    vkUpdateDescriptorSets(d->gpu->device, 1, &write, 0, NULL);
}

static bool fill(const struct gpu *gpu, const void *items, size_t size, VkBufferUsageFlags usage,
                 struct gpu_buffer *buffer)
{
    if (buffer->size < size || !buffer->buffer) {
        gpu_destroy_buffer(gpu, buffer);
        *buffer = (struct gpu_buffer){0};
        if (!gpu_create_buffer(gpu, size + size / 2 + 4096, usage, buffer))
            return false;
    }
    if (size > 0)
        memcpy(buffer->mapped, items, size);
    return true;
}

bool ui_drawing_prepare(struct ui_drawing *d, uint32_t slot_index,
                        const struct ui_geometry *geometry, const VkImageView *views)
{
    struct ui_draw_slot *slot = &d->slots[slot_index];
    show(d, slot, UI_TEXTURE_FONT, d->font.view);
    for (uint32_t i = UI_TEXTURE_PICTURE; i < UI_TEXTURE_COUNT; i++)
        show(d, slot, i, views[i] ? views[i] : d->font.view);
    return fill(d->gpu, geometry->vertices, geometry->vertex_count * sizeof *geometry->vertices,
                VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, &slot->vertices) &&
           fill(d->gpu, geometry->indices, geometry->index_count * sizeof *geometry->indices,
                VK_BUFFER_USAGE_INDEX_BUFFER_BIT, &slot->indices);
}

void ui_drawing_record(const struct ui_drawing *d, uint32_t slot_index,
                       const struct ui_geometry *geometry, VkCommandBuffer commands)
{
    const struct ui_draw_slot *slot = &d->slots[slot_index];
    const VkDeviceSize offset = 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, d->pipeline);
    vkCmdBindVertexBuffers(commands, 0, 1, &slot->vertices.buffer, &offset);
    vkCmdBindIndexBuffer(commands, slot->indices.buffer, 0, VK_INDEX_TYPE_UINT16);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, d->layout, 1, 1,
                            &slot->sets[UI_TEXTURE_OTHER], 0, NULL);
    for (uint32_t i = 0; i < geometry->draw_count; i++) {
        const struct ui_draw *draw = &geometry->draws[i];
        const VkRect2D clip = {
            {draw->clip[0], draw->clip[1]},
            {(uint32_t)(draw->clip[2] - draw->clip[0]), (uint32_t)(draw->clip[3] - draw->clip[1])}};
        const struct push push = {{2.0f / geometry->width, 2.0f / geometry->height}, draw->mode};
        vkCmdSetScissor(commands, 0, 1, &clip);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, d->layout, 0, 1,
                                &slot->sets[draw->texture], 0, NULL);
        vkCmdPushConstants(commands, d->layout,
                           VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                           sizeof push, &push);
        vkCmdDrawIndexed(commands, draw->index_count, 1, draw->first_index, draw->vertex_offset, 0);
    }
}
