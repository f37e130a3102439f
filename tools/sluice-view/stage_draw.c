#include "stage_draw.h"

#include "../../samples/common/draw_pipeline.h"

#include "scene_frag.h"
#include "scene_vert.h"

#include <stddef.h>
#include <string.h>

#define NEAR_PLANE 0.05f
#define FAR_PLANE 500.0f

/* As in shaders/scene_push.glsl. */
struct push {
    struct mat4 view_projection;
    float color[4];
    uint32_t table_index, view, seed;
    float probability, lod_bias, anisotropy, tint;
    uint32_t flags;
};
_Static_assert(sizeof(struct push) == 112, "as in scene_push.glsl");

static bool fill(const struct gpu *gpu, const void *items, size_t size, VkBufferUsageFlags usage,
                 struct gpu_buffer *buffer)
{
    if (!gpu_create_buffer(gpu, size, usage, buffer))
        return false;
    memcpy(buffer->mapped, items, size);
    return true;
}

static bool create_layout(struct stage_drawing *d, VkDescriptorSetLayout set_layout)
{
    const VkPushConstantRange range = {.stageFlags = VK_SHADER_STAGE_VERTEX_BIT |
                                                     VK_SHADER_STAGE_FRAGMENT_BIT,
                                       .size = sizeof(struct push)};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = 1,
                                             .pSetLayouts = &set_layout,
                                             .pushConstantRangeCount = 1,
                                             .pPushConstantRanges = &range};
    return gpu_check(vkCreatePipelineLayout(d->gpu->device, &info, NULL, &d->layout),
                     "vkCreatePipelineLayout");
}

static bool create_pipeline(struct stage_drawing *d, bool paged)
{
    const VkVertexInputBindingDescription binding = {0, sizeof(struct scene_vertex),
                                                     VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attributes[] = {
        {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct scene_vertex, position)},
        {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct scene_vertex, normal)},
        {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct scene_vertex, uv)}};
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = 1,
        .pVertexBindingDescriptions = &binding,
        .vertexAttributeDescriptionCount = 3,
        .pVertexAttributeDescriptions = attributes};
    const VkBool32 constant = paged;
    const VkSpecializationMapEntry entry = {0, 0, sizeof constant};
    const VkSpecializationInfo constants = {1, &entry, sizeof constant, &constant};
    struct draw_pipeline_info info = {
        .target = &d->targets[0],
        .layout = d->layout,
        .vertex = gpu_create_shader(d->gpu, scene_vert, sizeof scene_vert),
        .fragment = gpu_create_shader(d->gpu, scene_frag, sizeof scene_frag),
        .constants = &constants,
        .input = &input,
        .culled = VK_CULL_MODE_NONE};
    bool created =
        info.vertex && info.fragment && draw_pipeline_create(d->gpu, &info, &d->pipeline);
    vkDestroyShaderModule(d->gpu->device, info.vertex, NULL);
    vkDestroyShaderModule(d->gpu->device, info.fragment, NULL);
    return created;
}

bool stage_drawing_create(const struct gpu *gpu, const struct scene_data *scene,
                          VkDescriptorSetLayout set_layout, bool paged, struct stage_drawing *d)
{
    *d = (struct stage_drawing){.gpu = gpu};
    if (fill(gpu, scene->vertices, scene->vertex_count * sizeof *scene->vertices,
             VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, &d->vertices) &&
        fill(gpu, scene->indices, scene->index_count * sizeof *scene->indices,
             VK_BUFFER_USAGE_INDEX_BUFFER_BIT, &d->indices) &&
        target_create(gpu, 16, 16, 1, &d->targets[0]) && create_layout(d, set_layout) &&
        create_pipeline(d, paged))
        return true;
    stage_drawing_destroy(d);
    return false;
}

void stage_drawing_destroy(struct stage_drawing *d)
{
    if (!d->gpu)
        return;
    for (int i = 0; i < FRAMES_SLOTS; i++)
        target_destroy(d->gpu, &d->targets[i]);
    vkDestroyPipeline(d->gpu->device, d->pipeline, NULL);
    vkDestroyPipelineLayout(d->gpu->device, d->layout, NULL);
    gpu_destroy_buffer(d->gpu, &d->vertices);
    gpu_destroy_buffer(d->gpu, &d->indices);
    *d = (struct stage_drawing){0};
}

static bool fit_target(struct stage_drawing *d, struct target *target, uint32_t width,
                       uint32_t height)
{
    if (target->width == width && target->height == height)
        return true;
    target_destroy(d->gpu, target);
    *target = (struct target){0};
    return target_create(d->gpu, width, height, 1, target);
}

static struct mat4 matrix_of(const struct view_camera *camera, float aspect)
{
    const struct mat4 view =
        mat4_look_at(camera->position, vec3_add(camera->position, view_camera_forward(camera)));
    const struct mat4 projection = mat4_perspective(camera->fov, aspect, NEAR_PLANE, FAR_PLANE);
    return mat4_multiply(&projection, &view);
}

static void draw_parts(const struct stage_drawing *d, const struct scene_data *scene,
                       const struct stage_draw *draw, const uint32_t *table_indices,
                       VkCommandBuffer commands)
{
    const struct view_settings *s = draw->settings;
    const bool writes = s->feedback == VIEW_FEEDBACK_ON && !s->pause && !s->freeze_wants;
    struct push push = {.view_projection =
                            matrix_of(&draw->camera, (float)draw->width / (float)draw->height),
                        .view = s->view,
                        .seed = (uint32_t)draw->number,
                        .probability = writes ? (float)s->probability : 0.0f,
                        .lod_bias = (float)s->lod_bias,
                        .anisotropy = (float)s->anisotropy,
                        .tint = (float)s->tint,
                        .flags = s->borders ? 1u : 0u};
    for (uint32_t i = 0; i < scene->part_count; i++) {
        const struct scene_part *part = &scene->parts[i];
        push.table_index = part->image == SCENE_NO_IMAGE ? UINT32_MAX : table_indices[part->image];
        memcpy(push.color, part->color, sizeof push.color);
        vkCmdPushConstants(commands, d->layout,
                           VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                           sizeof push, &push);
        vkCmdDrawIndexed(commands, part->index_count, 1, part->first_index, 0, 0);
    }
}

/* The render pass leaves it for a copy; the user interface samples it. */
static void record_layout(const struct target *target, VkCommandBuffer commands)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
        .newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = target->color.image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
}

VkImageView stage_drawing_record(struct stage_drawing *d, const struct scene_data *scene,
                                 const struct stage_draw *draw, const uint32_t *table_indices,
                                 VkDescriptorSet set, uint32_t slot, VkCommandBuffer commands)
{
    static const float sky[4] = {0.16f, 0.18f, 0.21f, 1};
    const VkDeviceSize offset = 0;
    struct target *target = &d->targets[slot];
    if (!fit_target(d, target, draw->width, draw->height))
        return VK_NULL_HANDLE;
    target_begin(target, commands, sky);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, d->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, d->layout, 0, 1, &set, 0,
                            NULL);
    vkCmdBindVertexBuffers(commands, 0, 1, &d->vertices.buffer, &offset);
    vkCmdBindIndexBuffer(commands, d->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    draw_parts(d, scene, draw, table_indices, commands);
    target_end(target, commands);
    record_layout(target, commands);
    return target->color.view;
}
