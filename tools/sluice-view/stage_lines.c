#include "stage_lines.h"

#include "scene_lines_frag.h"
#include "scene_lines_vert.h"

#define INDICES_PER_TRIANGLE 6u

static bool create_indices(const struct gpu *gpu, const struct scene_data *scene,
                           struct stage_lines *lines)
{
    const size_t count = (size_t)scene->index_count / 3 * INDICES_PER_TRIANGLE;
    if (count == 0 || count > UINT32_MAX ||
        !gpu_create_buffer(gpu, count * sizeof(uint32_t), VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                           &lines->indices))
        return false;
    uint32_t *to = lines->indices.mapped;
    for (uint32_t i = 0; i + 2 < scene->index_count; i += 3)
        for (uint32_t k = 0; k < 3; k++) {
            *to++ = scene->indices[i + k];
            *to++ = scene->indices[i + (k + 1) % 3];
        }
    lines->index_count = (uint32_t)count;
    return true;
}

bool stage_lines_create(const struct gpu *gpu, const struct scene_data *scene,
                        const struct draw_pipeline_info *info, struct stage_lines *lines)
{
    struct draw_pipeline_info with = *info;
    with.vertex = gpu_create_shader(gpu, scene_lines_vert, sizeof scene_lines_vert);
    with.fragment = gpu_create_shader(gpu, scene_lines_frag, sizeof scene_lines_frag);
    with.lines = true;
    *lines = (struct stage_lines){0};
    const bool created = with.vertex && with.fragment &&
                         draw_pipeline_create(gpu, &with, &lines->pipeline) &&
                         create_indices(gpu, scene, lines);
    vkDestroyShaderModule(gpu->device, with.vertex, NULL);
    vkDestroyShaderModule(gpu->device, with.fragment, NULL);
    if (!created)
        stage_lines_destroy(gpu, lines);
    return created;
}

void stage_lines_destroy(const struct gpu *gpu, struct stage_lines *lines)
{
    vkDestroyPipeline(gpu->device, lines->pipeline, NULL);
    gpu_destroy_buffer(gpu, &lines->indices);
    *lines = (struct stage_lines){0};
}

void stage_lines_record(const struct stage_lines *lines, VkCommandBuffer commands)
{
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, lines->pipeline);
    vkCmdBindIndexBuffer(commands, lines->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, lines->index_count, 1, 0, 0, 0);
}
