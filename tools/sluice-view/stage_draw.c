#include "stage_draw.h"

#include "../../samples/common/draw_pipeline.h"

#include "scene_frag.h"
#include "scene_masked_frag.h"
#include "scene_vert.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const float sky[4] = {0.0220f, 0.0272f, 0.0363f, 1}; /* linear: (41, 46, 54) in sRGB */

#define NEAR_PLANE 0.05f /* meters, if the scene is about as large as a room */
#define FAR_PLANE 500.0f
#define BOTH_SIDES 3u

/* Same layout as in shaders/scene_push.glsl. */
struct push {
    struct mat4 view_projection;
    struct vec3 eye;
    uint32_t material, view, seed;
    float probability, lod_bias, anisotropy, tint;
    uint32_t flags;
};
_Static_assert(sizeof(struct push) == 108, "as in scene_push.glsl");

/** A part that blends, and its distance from the camera. */
struct stage_order {
    float distance;
    uint32_t part;
};

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
    const VkDescriptorSetLayout layouts[2] = {set_layout, d->sets.layout};
    const VkPushConstantRange range = {.stageFlags = VK_SHADER_STAGE_VERTEX_BIT |
                                                     VK_SHADER_STAGE_FRAGMENT_BIT,
                                       .size = sizeof(struct push)};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = 2,
                                             .pSetLayouts = layouts,
                                             .pushConstantRangeCount = 1,
                                             .pPushConstantRanges = &range};
    return gpu_check(vkCreatePipelineLayout(d->gpu->device, &info, NULL, &d->layout),
                     "vkCreatePipelineLayout");
}

static uint32_t pipeline_of(const struct scene_material *material)
{
    return (uint32_t)material->alpha + (material->double_sided ? BOTH_SIDES : 0u);
}

/* Lists the shaders of the build. */
static void list_shaders(struct shader_code code[SCENE_SHADER_COUNT])
{
    code[SCENE_VERTEX] = (struct shader_code){(uint32_t *)scene_vert, sizeof scene_vert};
    code[SCENE_FRAGMENT] = (struct shader_code){(uint32_t *)scene_frag, sizeof scene_frag};
    code[SCENE_MASKED_FRAGMENT] =
        (struct shader_code){(uint32_t *)scene_masked_frag, sizeof scene_masked_frag};
}

static VkShaderModule create_fragment(const struct gpu *gpu, const struct shader_code *code,
                                      uint32_t pipeline)
{
    code += pipeline % BOTH_SIDES == ALPHA_MASK ? SCENE_MASKED_FRAGMENT : SCENE_FRAGMENT;
    return gpu_create_shader(gpu, code->words, code->size);
}

static const VkVertexInputBindingDescription vertex_binding = {0, sizeof(struct scene_vertex),
                                                               VK_VERTEX_INPUT_RATE_VERTEX};
static const VkVertexInputAttributeDescription vertex_attributes[] = {
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct scene_vertex, position)},
    {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct scene_vertex, normal)},
    {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct scene_vertex, uv)},
    {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct scene_vertex, uv[1])}};

static VkPipelineVertexInputStateCreateInfo vertex_input(uint32_t attributes)
{
    return (VkPipelineVertexInputStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = 1,
        .pVertexBindingDescriptions = &vertex_binding,
        .vertexAttributeDescriptionCount = attributes,
        .pVertexAttributeDescriptions = vertex_attributes};
}

static bool create_pipeline(struct stage_drawing *d, const struct shader_code *code,
                            uint32_t pipeline, VkPipeline *created)
{
    const VkPipelineVertexInputStateCreateInfo input = vertex_input(4);
    const VkBool32 constant = d->paged;
    const VkSpecializationMapEntry entry = {0, 0, sizeof constant};
    const VkSpecializationInfo constants = {1, &entry, sizeof constant, &constant};
    struct draw_pipeline_info info = {
        .target = &d->targets[0],
        .layout = d->layout,
        .vertex = gpu_create_shader(d->gpu, code[SCENE_VERTEX].words, code[SCENE_VERTEX].size),
        .fragment = create_fragment(d->gpu, code, pipeline),
        .constants = &constants,
        .input = &input,
        .culled = pipeline >= BOTH_SIDES ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT,
        .blended = pipeline % BOTH_SIDES == ALPHA_BLEND};
    const bool done = info.vertex && info.fragment && draw_pipeline_create(d->gpu, &info, created);
    vkDestroyShaderModule(d->gpu->device, info.vertex, NULL);
    vkDestroyShaderModule(d->gpu->device, info.fragment, NULL);
    return done;
}

static void destroy_pipelines(const struct gpu *gpu, VkPipeline pipelines[STAGE_PIPELINES])
{
    for (int i = 0; i < STAGE_PIPELINES; i++) {
        vkDestroyPipeline(gpu->device, pipelines[i], NULL);
        pipelines[i] = VK_NULL_HANDLE;
    }
}

bool stage_drawing_prepare(struct stage_drawing *d, const struct scene_data *scene,
                           const struct shader_code code[SCENE_SHADER_COUNT])
{
    stage_drawing_drop(d);
    for (uint32_t i = 0; i < scene->part_count; i++) {
        const uint32_t pipeline = pipeline_of(&scene->materials[scene->parts[i].material]);
        if (d->prepared[pipeline] || create_pipeline(d, code, pipeline, &d->prepared[pipeline]))
            continue;
        stage_drawing_drop(d);
        return false;
    }
    return true;
}

void stage_drawing_take(struct stage_drawing *d)
{
    destroy_pipelines(d->gpu, d->pipelines);
    memcpy(d->pipelines, d->prepared, sizeof d->pipelines);
    memset(d->prepared, 0, sizeof d->prepared);
}

void stage_drawing_drop(struct stage_drawing *d)
{
    destroy_pipelines(d->gpu, d->prepared);
}

bool stage_drawing_create(const struct gpu *gpu, const struct scene_data *scene,
                          const struct stage_drawing_info *info, struct stage_drawing *d)
{
    struct shader_code built[SCENE_SHADER_COUNT];
    *d = (struct stage_drawing){.gpu = gpu, .marks = info->marks, .paged = info->paged};
    list_shaders(built);
    d->order = calloc(scene->part_count + 1u, sizeof *d->order);
    if (d->order &&
        fill(gpu, scene->vertices, scene->vertex_count * sizeof *scene->vertices,
             VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, &d->vertices) &&
        fill(gpu, scene->indices, scene->index_count * sizeof *scene->indices,
             VK_BUFFER_USAGE_INDEX_BUFFER_BIT, &d->indices) &&
        stage_sets_create(gpu, scene, info->table_indices, tile_marks_size(d->marks), &d->sets) &&
        target_create_encoding(gpu, 16, 16, &d->targets[0]) && create_layout(d, info->set_layout) &&
        stage_drawing_prepare(d, scene, info->code ? info->code : built)) {
        stage_drawing_take(d);
        return true;
    }
    stage_drawing_destroy(d);
    return false;
}

void stage_drawing_destroy(struct stage_drawing *d)
{
    if (!d->gpu)
        return;
    for (int i = 0; i < FRAMES_SLOTS; i++) {
        target_destroy(d->gpu, &d->targets[i]);
        target_destroy(d->gpu, &d->ahead[i]);
    }
    destroy_pipelines(d->gpu, d->pipelines);
    stage_drawing_drop(d);
    vkDestroyPipelineLayout(d->gpu->device, d->layout, NULL);
    stage_lines_destroy(d->gpu, &d->lines);
    stage_sets_destroy(&d->sets);
    free(d->order);
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
    return target_create_encoding(d->gpu, width, height, target);
}

/* Returns an orthographic projection with depth 0 at the camera. */
static struct mat4 parallel_projection(const struct view_extent *extent, float far)
{
    return (struct mat4){
        {{1 / extent->x, 0, 0, 0}, {0, -1 / extent->y, 0, 0}, {0, 0, -1 / far, 0}, {0, 0, 0, 1}}};
}

static struct mat4 matrix_of(const struct scene_data *scene, const struct view_camera *camera,
                             float aspect)
{
    const struct vec3 box = vec3_sub(scene->bounds[1], scene->bounds[0]);
    const float size = sqrtf(vec3_dot(box, box));
    const float near = size < 20 ? NEAR_PLANE * fmaxf(size, 1e-3f) / 20 : NEAR_PLANE;
    const float far = fmaxf(FAR_PLANE * near / NEAR_PLANE, 8 * size);
    struct mat4 view;
    view_camera_matrix(camera, view.m);
    const struct view_extent extent = view_camera_extent(camera, aspect);
    const struct mat4 projection = camera->span > 0
                                       ? parallel_projection(&extent, far)
                                       : mat4_perspective(2 * atanf(extent.y), aspect, near, far);
    return mat4_multiply(&projection, &view);
}

static bool writes_feedback(const struct view_settings *s)
{
    return s->feedback == VIEW_FEEDBACK_ON && !s->pause && !s->freeze_wants;
}

/* Returns the FLAG_... bits of scene_push.glsl. */
static uint32_t flags_of(const struct view_settings *s)
{
    const uint32_t borders = s->borders == VIEW_NUMBERED_BORDERS ? 3u
                             : s->borders == VIEW_BORDERS        ? 1u
                                                                 : 0u;
    return borders | (s->filter == VIEW_NEAREST ? 4u : 0u) | (s->alpha_test == VIEW_OFF ? 8u : 0u) |
           (s->texture_sets == VIEW_OFF ? 16u : 0u) | (uint32_t)s->feedback_by << 8 |
           s->finest_level << 12;
}

/* Probability that a pixel selected by `feedback_by` writes feedback. 0: no pixel writes. */
static float probability_of(const struct view_settings *s)
{
    if (!writes_feedback(s))
        return 0.0f;
    return s->feedback_by == VIEW_BY_QUADS ? (float)s->probability : 1.0f;
}

static struct push push_of(const struct scene_data *scene, const struct stage_draw *draw)
{
    const struct view_settings *s = draw->settings;
    return (struct push){.view_projection = matrix_of(scene, &draw->camera,
                                                      (float)draw->width / (float)draw->height),
                         .eye = draw->camera.position,
                         .view = s->view == VIEW_TRUTH ? VIEW_PICTURE : s->view,
                         .seed = (uint32_t)draw->number,
                         .probability = probability_of(s),
                         .lod_bias = (float)s->lod_bias,
                         .anisotropy = s->filter == VIEW_NEAREST ? 1.0f : (float)s->anisotropy,
                         .tint = (float)s->tint,
                         .flags = flags_of(s)};
}

static void draw_part(const struct stage_drawing *d, const struct scene_part *part,
                      struct push *push, VkCommandBuffer commands)
{
    push->material = part->material;
    vkCmdPushConstants(commands, d->layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof *push,
                       push);
    vkCmdDrawIndexed(commands, part->index_count, 1, part->first_index, 0, 0);
}

static int compare_far_first(const void *a, const void *b)
{
    const struct stage_order *left = a, *right = b;
    if (left->distance != right->distance)
        return left->distance < right->distance ? 1 : -1;
    return left->part < right->part ? -1 : 1;
}

/* Orders the parts that blend by distance. Returns their number. */
static uint32_t order_blended(struct stage_drawing *d, const struct scene_data *scene,
                              const struct vec3 eye)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->part_count; i++) {
        const struct vec3 to = vec3_sub(scene->parts[i].center, eye);
        if (scene->materials[scene->parts[i].material].alpha == ALPHA_BLEND)
            d->order[count++] = (struct stage_order){vec3_dot(to, to), i};
    }
    qsort(d->order, count, sizeof *d->order, compare_far_first);
    return count;
}

/* Draws opaque and masked parts first, then parts that blend. */
static void draw_parts(struct stage_drawing *d, const struct scene_data *scene,
                       const struct stage_draw *draw, VkCommandBuffer commands)
{
    struct push push = push_of(scene, draw);
    for (uint32_t pipeline = 0; pipeline < STAGE_PIPELINES; pipeline++) {
        if (!d->pipelines[pipeline] || pipeline % BOTH_SIDES == ALPHA_BLEND)
            continue;
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, d->pipelines[pipeline]);
        for (uint32_t i = 0; i < scene->part_count; i++)
            if (pipeline_of(&scene->materials[scene->parts[i].material]) == pipeline)
                draw_part(d, &scene->parts[i], &push, commands);
    }
    const uint32_t blended = order_blended(d, scene, draw->camera.position);
    for (uint32_t i = 0; i < blended; i++) {
        const struct scene_part *part = &scene->parts[d->order[i].part];
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                          d->pipelines[pipeline_of(&scene->materials[part->material])]);
        draw_part(d, part, &push, commands);
    }
}

static bool draw_lines(struct stage_drawing *d, const struct scene_data *scene,
                       const struct stage_draw *draw, VkCommandBuffer commands)
{
    const VkPipelineVertexInputStateCreateInfo input = vertex_input(1); /* the position */
    const struct draw_pipeline_info info = {
        .target = &d->targets[0], .layout = d->layout, .input = &input};
    const struct push push = push_of(scene, draw);
    if (!draw->settings->wireframe || scene->index_count < 3)
        return true;
    if (!d->lines.pipeline && !stage_lines_create(d->gpu, scene, &info, &d->lines))
        return false;
    vkCmdPushConstants(commands, d->layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                       &push);
    stage_lines_record(&d->lines, commands);
    vkCmdBindIndexBuffer(commands, d->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    return true;
}

/* Records a barrier: the render pass leaves the target ready for a copy, and the user interface
 * samples it. */
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

/* Draws the scene from the predicted camera, for its feedback alone. Sets and buffers are bound. */
static bool record_ahead(struct stage_drawing *d, const struct scene_data *scene,
                         const struct stage_draw *draw, uint32_t slot, VkCommandBuffer commands)
{
    static const float black[4] = {0, 0, 0, 1};
    struct view_settings settings = *draw->settings;
    struct stage_draw ahead = {.settings = &settings,
                               .camera = draw->ahead.camera,
                               .width = draw->ahead.width,
                               .height = draw->ahead.height,
                               .number = draw->number};
    if (!draw->ahead.draw || !writes_feedback(draw->settings))
        return true;
    settings.lod_bias += (double)draw->ahead.lod_bias;
    settings.view = VIEW_PICTURE;
    settings.borders = 0;
    if (!fit_target(d, &d->ahead[slot], ahead.width, ahead.height))
        return false;
    target_begin(&d->ahead[slot], commands, black);
    draw_parts(d, scene, &ahead, commands);
    target_end(&d->ahead[slot], commands);
    return true;
}

/* Draws the large screenshot. Its pixels write no feedback, so streaming is not affected. */
static bool record_large(struct stage_drawing *d, const struct scene_data *scene,
                         const struct stage_draw *draw, VkCommandBuffer commands)
{
    struct view_settings settings = *draw->settings;
    struct stage_draw large = *draw;
    if (!draw->large)
        return true;
    settings.feedback = VIEW_FEEDBACK_OFF;
    large.settings = &settings;
    large.width = draw->large->width;
    large.height = draw->large->height;
    target_begin(draw->large, commands, sky);
    draw_parts(d, scene, &large, commands);
    const bool drawn = draw_lines(d, scene, &large, commands);
    target_end(draw->large, commands);
    target_copy_out(draw->large, commands, draw->large_copy);
    return drawn;
}

VkImageView stage_drawing_record(struct stage_drawing *d, const struct scene_data *scene,
                                 const struct stage_draw *draw, VkDescriptorSet set, uint32_t slot,
                                 VkCommandBuffer commands)
{
    const VkDeviceSize offset = 0;
    struct target *target = &d->targets[slot];
    if (!fit_target(d, target, draw->width, draw->height))
        return VK_NULL_HANDLE;
    tile_marks_copy(d->marks, d->sets.marks[slot].mapped);
    target_begin(target, commands, sky);
    const VkDescriptorSet sets[2] = {set, d->sets.sets[slot]};
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, d->layout, 0, 2, sets, 0,
                            NULL);
    vkCmdBindVertexBuffers(commands, 0, 1, &d->vertices.buffer, &offset);
    vkCmdBindIndexBuffer(commands, d->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    draw_parts(d, scene, draw, commands);
    const bool drawn = draw_lines(d, scene, draw, commands);
    target_end(target, commands);
    if (!drawn || !record_ahead(d, scene, draw, slot, commands) ||
        !record_large(d, scene, draw, commands))
        return VK_NULL_HANDLE;
    if (draw->copy)
        target_copy_out(target, commands, draw->copy);
    record_layout(target, commands);
    return target->color.view;
}
