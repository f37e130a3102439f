#include "renderer.h"

#include "../common/draw_pipeline.h"

#include <stddef.h>
#include <string.h>

#include "gallery_vert.h"
#include "count_frag.h"
#include "count_paged_frag.h"
#include "needs_frag.h"
#include "plain_frag.h"
#include "surface_frag.h"
#include "surface_paged_frag.h"

/** Creates a layout of `count` descriptors of one type, at bindings 0, 1, ... */
static bool create_set_layout(const struct gpu *gpu, VkDescriptorType type, uint32_t count,
                              VkDescriptorSetLayout *layout)
{
    VkDescriptorSetLayoutBinding bindings[4];
    for (uint32_t i = 0; i < count; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            i, type, 1, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = count,
                                            .pBindings = bindings};
    return gpu_check(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, layout),
                     "vkCreateDescriptorSetLayout");
}

static bool create_layouts(struct renderer *renderer, const struct renderer_request *request)
{
    const struct gpu *gpu = renderer->gpu;
    if (!create_set_layout(gpu, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4,
                           &renderer->texture_layout) ||
        !create_set_layout(gpu, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, GALLERY_BINDING_COUNT,
                           &renderer->frame_layout))
        return false;

    const VkDescriptorSetLayout sets[] = {request->streamer_layout, renderer->texture_layout,
                                          renderer->frame_layout, request->neural_layout};
    const VkPushConstantRange constants = {VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                           sizeof(struct GalleryDraw)};
    VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                       .setLayoutCount = request->neural_layout ? 4 : 3,
                                       .pSetLayouts = sets,
                                       .pushConstantRangeCount = 1,
                                       .pPushConstantRanges = &constants};
    return gpu_check(vkCreatePipelineLayout(gpu->device, &info, NULL, &renderer->pipeline_layout),
                     "vkCreatePipelineLayout");
}

static bool create_sampler(const struct gpu *gpu, VkSamplerAddressMode address, bool probe,
                           uint32_t anisotropy, VkSampler *sampler)
{
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_LINEAR,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = probe ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                    : VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .addressModeU = address,
                                .addressModeV = address,
                                .addressModeW = address,
                                .anisotropyEnable = !probe && anisotropy > 1,
                                .maxAnisotropy = (float)anisotropy,
                                .maxLod = VK_LOD_CLAMP_NONE};
    return gpu_check(vkCreateSampler(gpu->device, &info, NULL, sampler), "vkCreateSampler");
}

static bool create_samplers(struct renderer *renderer, uint32_t anisotropy)
{
    const VkSamplerAddressMode clamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    const VkSamplerAddressMode repeat = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    return create_sampler(renderer->gpu, clamp, false, anisotropy, &renderer->clamp) &&
           create_sampler(renderer->gpu, repeat, false, anisotropy, &renderer->repeat) &&
           create_sampler(renderer->gpu, clamp, true, 1, &renderer->probe_clamp) &&
           create_sampler(renderer->gpu, repeat, true, 1, &renderer->probe_repeat);
}

static bool create_buffers(struct renderer *renderer)
{
    const struct room *room = renderer->room;
    size_t vertex_size = room->vertex_count * sizeof *room->vertices;
    size_t light_size = room->place_count * sizeof *room->lights;
    if (!gpu_create_buffer(renderer->gpu, vertex_size, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                           &renderer->vertices) ||
        !gpu_create_buffer(renderer->gpu, light_size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                           &renderer->lights))
        return false;
    memcpy(renderer->vertices.mapped, room->vertices, vertex_size);
    memcpy(renderer->lights.mapped, room->lights, light_size);
    return true;
}

static const VkVertexInputBindingDescription vertex_binding = {0, sizeof(struct room_vertex),
                                                               VK_VERTEX_INPUT_RATE_VERTEX};
static const VkVertexInputAttributeDescription vertex_attributes[] = {
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct room_vertex, position)},
    {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct room_vertex, normal)},
    {2, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct room_vertex, tangent)},
    {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(struct room_vertex, uv)},
};

bool renderer_create_pipeline(const struct renderer *renderer, const struct target *target,
                              VkShaderModule fragment, bool writes_color, VkPipeline *pipeline)
{
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = 1,
        .pVertexBindingDescriptions = &vertex_binding,
        .vertexAttributeDescriptionCount = 4,
        .pVertexAttributeDescriptions = vertex_attributes};
    const struct draw_pipeline_info info = {.target = target,
                                            .layout = renderer->pipeline_layout,
                                            .vertex = renderer->vertex,
                                            .fragment = fragment,
                                            .input = &input,
                                            .culled = VK_CULL_MODE_BACK_BIT,
                                            .no_color = !writes_color};
    return draw_pipeline_create(renderer->gpu, &info, pipeline);
}

static bool create_pipelines(struct renderer *renderer, const struct renderer_request *request)
{
    const struct gpu *gpu = renderer->gpu;
    const struct {
        const uint32_t *words;
        size_t size;
    } fragments[RENDERER_PASS_COUNT] =
        {
            [RENDERER_PLAIN] = {plain_frag, sizeof plain_frag},
            [RENDERER_SURFACE] = {surface_frag, sizeof surface_frag},
            [RENDERER_NEURAL] = {request->neural_words, request->neural_size},
            [RENDERER_COUNT] = {count_frag, sizeof count_frag},
            [RENDERER_NEEDS] = {needs_frag, sizeof needs_frag},
        },
      paged_fragments[RENDERER_PASS_COUNT] = {
          [RENDERER_PLAIN] = {plain_frag, sizeof plain_frag},
          [RENDERER_SURFACE] = {surface_paged_frag, sizeof surface_paged_frag},
          [RENDERER_NEURAL] = {request->neural_words, request->neural_size},
          [RENDERER_COUNT] = {count_paged_frag, sizeof count_paged_frag},
          [RENDERER_NEEDS] = {needs_frag, sizeof needs_frag},
      };
    renderer->vertex = gpu_create_shader(gpu, gallery_vert, sizeof gallery_vert);
    bool created = renderer->vertex != VK_NULL_HANDLE;
    for (int i = 0; created && i < RENDERER_PASS_COUNT; i++) {
        if ((i == RENDERER_COUNT && !request->counting) ||
            (i == RENDERER_NEEDS && !request->needs) ||
            (i == RENDERER_NEURAL && !request->neural_layout))
            continue;
        VkShaderModule fragment =
            request->paged
                ? gpu_create_shader(gpu, paged_fragments[i].words, paged_fragments[i].size)
                : gpu_create_shader(gpu, fragments[i].words, fragments[i].size);
        created = fragment != VK_NULL_HANDLE &&
                  renderer_create_pipeline(renderer, request->target, fragment, i < RENDERER_COUNT,
                                           &renderer->pipelines[i]);
        vkDestroyShaderModule(gpu->device, fragment, NULL);
    }
    return created;
}

bool renderer_create(const struct gpu *gpu, const struct renderer_request *request,
                     struct renderer *renderer)
{
    *renderer = (struct renderer){.gpu = gpu, .room = request->room};
    if (create_layouts(renderer, request) && create_samplers(renderer, request->anisotropy) &&
        create_buffers(renderer) && create_pipelines(renderer, request))
        return true;
    renderer_destroy(renderer);
    return false;
}

void renderer_destroy(struct renderer *renderer)
{
    if (!renderer->gpu)
        return;
    VkDevice device = renderer->gpu->device;
    for (int i = 0; i < RENDERER_PASS_COUNT; i++)
        vkDestroyPipeline(device, renderer->pipelines[i], NULL);
    vkDestroyShaderModule(device, renderer->vertex, NULL);
    gpu_destroy_buffer(renderer->gpu, &renderer->vertices);
    gpu_destroy_buffer(renderer->gpu, &renderer->lights);
    vkDestroySampler(device, renderer->clamp, NULL);
    vkDestroySampler(device, renderer->repeat, NULL);
    vkDestroySampler(device, renderer->probe_clamp, NULL);
    vkDestroySampler(device, renderer->probe_repeat, NULL);
    vkDestroyPipelineLayout(device, renderer->pipeline_layout, NULL);
    vkDestroyDescriptorSetLayout(device, renderer->texture_layout, NULL);
    vkDestroyDescriptorSetLayout(device, renderer->frame_layout, NULL);
    *renderer = (struct renderer){0};
}

void renderer_write_frame_set(const struct renderer *renderer, VkDescriptorSet set, VkBuffer frame,
                              VkBuffer counts, VkBuffer required)
{
    const VkDescriptorBufferInfo infos[GALLERY_BINDING_COUNT] = {
        [GALLERY_BINDING_FRAME] = {frame, 0, VK_WHOLE_SIZE},
        [GALLERY_BINDING_LIGHTS] = {renderer->lights.buffer, 0, VK_WHOLE_SIZE},
        [GALLERY_BINDING_COUNTS] = {counts, 0, VK_WHOLE_SIZE},
        [GALLERY_BINDING_REQUIRED] = {required, 0, VK_WHOLE_SIZE},
    };
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set,
                                  .descriptorCount = GALLERY_BINDING_COUNT,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = infos};
    vkUpdateDescriptorSets(renderer->gpu->device, 1, &write, 0, NULL);
}

void renderer_write_texture_set(const struct renderer *renderer, VkDescriptorSet set,
                                VkImageView color, VkImageView relief, bool repeat)
{
    VkSampler drawn = repeat ? renderer->repeat : renderer->clamp;
    VkSampler probe = repeat ? renderer->probe_repeat : renderer->probe_clamp;
    const VkDescriptorImageInfo infos[4] = {
        {drawn, color, VK_IMAGE_LAYOUT_GENERAL},
        {drawn, relief, VK_IMAGE_LAYOUT_GENERAL},
        {probe, color, VK_IMAGE_LAYOUT_GENERAL},
        {probe, relief, VK_IMAGE_LAYOUT_GENERAL},
    };
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set,
                                  .descriptorCount = 4,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                  .pImageInfo = infos};
    vkUpdateDescriptorSets(renderer->gpu->device, 1, &write, 0, NULL);
}

const struct renderer_surface *renderer_surface_of(const struct room_part *part,
                                                   const struct renderer_surface *surfaces)
{
    switch (part->surface) {
    case ROOM_PLAIN: return NULL;
    case ROOM_FLOOR: return &surfaces[0];
    case ROOM_WALL: return &surfaces[1];
    case ROOM_PICTURE: {
        const struct renderer_surface *surface = &surfaces[2 + part->picture];
        return surface->missing || surface->decoded ? NULL : surface;
    }
    }
    return NULL;
}

/** Returns the surface of a part that the shader decodes, or NULL. */
static const struct renderer_surface *decoded_surface_of(const struct room_part *part,
                                                         const struct renderer_surface *surfaces)
{
    return part->surface == ROOM_PICTURE && surfaces[2 + part->picture].decoded
               ? &surfaces[2 + part->picture]
               : NULL;
}

static struct GalleryDraw draw_of(const struct room_part *part,
                                  const struct renderer_surface *surface)
{
    struct GalleryDraw draw = {.colorTexture = GALLERY_NO_TEXTURE,
                               .reliefTexture = GALLERY_NO_TEXTURE,
                               .flags = part->glowing ? GALLERY_GLOWING : 0};
    memcpy(draw.lights, part->lights, sizeof draw.lights);
    memcpy(draw.color, part->color, sizeof draw.color);
    for (int i = 1; i < GALLERY_LIGHTS_PER_DRAW; i++) /* count each lamp once */
        if (part->lights[i] == part->lights[0])
            draw.lights[i] = GALLERY_NO_TEXTURE;
    if (!surface)
        return draw;
    draw.colorTexture = surface->color_index;
    draw.reliefTexture = surface->relief_index;
    draw.reliefFeedback = surface->relief_feedback;
    draw.exposure = surface->exposure;
    draw.reliefScale = surface->relief_scale;
    draw.flags |= (surface->gray ? GALLERY_GRAY : 0) | (surface->painted ? GALLERY_PAINTED : 0) |
                  (surface->hdr ? GALLERY_HDR : 0);
    return draw;
}

void renderer_bind(const struct renderer *renderer, VkCommandBuffer commands,
                   const struct renderer_sets *sets)
{
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &renderer->vertices.buffer, &offset);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, renderer->pipeline_layout, 0,
                            1, &sets->streamer, 0, NULL);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, renderer->pipeline_layout, 2,
                            1, &sets->frame, 0, NULL);
    if (sets->neural)
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                                renderer->pipeline_layout, 3, 1, &sets->neural, 0, NULL);
}

void renderer_draw(const struct renderer *renderer, VkCommandBuffer commands,
                   const struct renderer_sets *sets, const struct renderer_surface *surfaces,
                   enum renderer_pass pass)
{
    const struct room *room = renderer->room;
    VkPipeline bound = VK_NULL_HANDLE;
    renderer_bind(renderer, commands, sets);
    for (uint32_t i = 0; i < room->part_count; i++) {
        const struct room_part *part = &room->parts[i];
        const struct renderer_surface *surface = renderer_surface_of(part, surfaces);
        const struct renderer_surface *decoded =
            pass == RENDERER_SURFACE ? decoded_surface_of(part, surfaces) : NULL;
        VkPipeline pipeline = renderer->pipelines[decoded   ? RENDERER_NEURAL
                                                  : surface ? pass
                                                            : RENDERER_PLAIN];
        if (pipeline != bound)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        bound = pipeline;
        if (surface)
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                                    renderer->pipeline_layout, 1, 1, &surface->textures, 0, NULL);
        struct GalleryDraw draw = draw_of(part, decoded ? decoded : surface);
        vkCmdPushConstants(commands, renderer->pipeline_layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                           sizeof draw, &draw);
        vkCmdDraw(commands, part->vertex_count, 1, part->first_vertex, 0);
    }
}
