/** The edges of a scene's triangles as lines over the picture. */
#ifndef SLUICE_VIEW_STAGE_LINES_H
#define SLUICE_VIEW_STAGE_LINES_H

#include "scene_data.h"

#include "../../samples/common/draw_pipeline.h"

struct stage_lines {
    struct gpu_buffer indices;
    uint32_t index_count;
    VkPipeline pipeline;
};

/** `info`: target, layout and vertex input of the scene. Says on stderr what failed. */
bool stage_lines_create(const struct gpu *gpu, const struct scene_data *scene,
                        const struct draw_pipeline_info *info, struct stage_lines *lines);
/** No frame may be in flight. A zeroed struct is fine. */
void stage_lines_destroy(const struct gpu *gpu, struct stage_lines *lines);
/** In a render pass. Sets, vertices and push constants are those of the scene; the buffer of
 *  indices is another one afterwards. */
void stage_lines_record(const struct stage_lines *lines, VkCommandBuffer commands);

#endif /* SLUICE_VIEW_STAGE_LINES_H */
