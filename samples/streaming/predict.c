#include "predict.h"

#include <string.h>

#include "predict_frag.h"

static bool create_pipelines(struct predict *predict)
{
    const struct renderer *renderer = predict->renderer;
    VkShaderModule fragment = gpu_create_shader(renderer->gpu, predict_frag, sizeof predict_frag);
    bool created =
        fragment &&
        renderer_create_pipeline(renderer, &predict->target, fragment, false, &predict->streamed) &&
        renderer_create_pipeline(renderer, &predict->target, VK_NULL_HANDLE, false,
                                 &predict->hiding);
    vkDestroyShaderModule(renderer->gpu->device, fragment, NULL);
    return created;
}

static bool create_pool(struct predict *predict)
{
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                       GALLERY_BINDING_COUNT * PREDICT_SLOTS};
    VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = PREDICT_SLOTS,
                                       .poolSizeCount = 1,
                                       .pPoolSizes = &size};
    return gpu_check(
        vkCreateDescriptorPool(predict->renderer->gpu->device, &info, NULL, &predict->pool),
        "vkCreateDescriptorPool");
}

static bool create_slot(const struct predict *predict, struct predict_slot *slot)
{
    const struct renderer *renderer = predict->renderer;
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = predict->pool,
                                        .descriptorSetCount = 1,
                                        .pSetLayouts = &renderer->frame_layout};
    if (!gpu_check(vkAllocateDescriptorSets(renderer->gpu->device, &info, &slot->set),
                   "vkAllocateDescriptorSets") ||
        !gpu_create_buffer(renderer->gpu, sizeof(struct GalleryFrame),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &slot->frame))
        return false;
    /* Bind any buffer for the counters, because this pass counts nothing. */
    renderer_write_frame_set(renderer, slot->set, slot->frame.buffer, slot->frame.buffer,
                             slot->frame.buffer);
    return true;
}

static uint32_t shrunk(uint32_t size)
{
    return (size + PREDICT_SHRINKS - 1) / PREDICT_SHRINKS;
}

bool predict_create(const struct renderer *renderer, const struct target *picture,
                    struct predict *predict)
{
    *predict = (struct predict){.renderer = renderer};
    bool created = target_create(renderer->gpu, shrunk(picture->width), shrunk(picture->height), 1,
                                 &predict->target) &&
                   create_pipelines(predict) && create_pool(predict);
    for (uint32_t i = 0; created && i < PREDICT_SLOTS; i++)
        created = create_slot(predict, &predict->slots[i]);
    if (!created)
        predict_destroy(predict);
    return created;
}

void predict_destroy(struct predict *predict)
{
    if (!predict->renderer)
        return;
    const struct gpu *gpu = predict->renderer->gpu;
    for (uint32_t i = 0; i < PREDICT_SLOTS; i++)
        gpu_destroy_buffer(gpu, &predict->slots[i].frame);
    vkDestroyDescriptorPool(gpu->device, predict->pool, NULL);
    vkDestroyPipeline(gpu->device, predict->streamed, NULL);
    vkDestroyPipeline(gpu->device, predict->hiding, NULL);
    target_destroy(gpu, &predict->target);
    *predict = (struct predict){0};
}

static void draw_part(const struct predict *predict, VkCommandBuffer commands,
                      const struct room_part *part, const struct renderer_surface *surface)
{
    if (surface) {
        struct GalleryDraw draw = {.colorTexture = surface->color_index,
                                   .reliefTexture = surface->relief_index,
                                   .reliefFeedback = surface->relief_feedback};
        vkCmdPushConstants(commands, predict->renderer->pipeline_layout,
                           VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof draw, &draw);
    }
    vkCmdDraw(commands, part->vertex_count, 1, part->first_vertex, 0);
}

void predict_record(const struct predict *predict, VkCommandBuffer commands,
                    VkDescriptorSet streamer_set, uint32_t slot, const struct GalleryFrame *frame,
                    const struct renderer_surface *surfaces)
{
    const struct renderer *renderer = predict->renderer;
    const struct room *room = renderer->room;
    static const float black[4] = {0, 0, 0, 0};
    const struct renderer_sets sets = {streamer_set, predict->slots[slot].set};
    VkPipeline bound = VK_NULL_HANDLE;
    memcpy(predict->slots[slot].frame.mapped, frame, sizeof *frame);
    target_begin(&predict->target, commands, black);
    renderer_bind(renderer, commands, &sets);
    for (uint32_t i = 0; i < room->part_count; i++) {
        const struct room_part *part = &room->parts[i];
        const struct renderer_surface *surface = renderer_surface_of(part, surfaces);
        VkPipeline pipeline = surface ? predict->streamed : predict->hiding;
        if (pipeline != bound)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        bound = pipeline;
        draw_part(predict, commands, part, surface);
    }
    target_end(&predict->target, commands);
}
