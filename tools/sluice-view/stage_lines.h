/** Edges of a scene's triangles, drawn as lines over the picture. */
#ifndef SLUICE_VIEW_STAGE_LINES_H
#define SLUICE_VIEW_STAGE_LINES_H

#include "scene_data.h"

#include "../../samples/common/draw_pipeline.h"

struct stage_lines {
    struct gpu_buffer indices;
    uint32_t index_count;
    VkPipeline pipeline;
};

/** Creates lines. `info`: target, layout and vertex input of the scene. False, with a line on
 * stderr, on failure. */
bool stage_lines_create(const struct gpu *gpu, const struct scene_data *scene,
                        const struct draw_pipeline_info *info, struct stage_lines *lines);
/** Destroys the lines. No frame may be in flight. A zeroed struct is allowed. */
void stage_lines_destroy(const struct gpu *gpu, struct stage_lines *lines);
/** Records the lines. Call in the scene's render pass, with its sets, vertices and push constants
 *  bound. Binds another index buffer. */
void stage_lines_record(const struct stage_lines *lines, VkCommandBuffer commands);

#endif /* SLUICE_VIEW_STAGE_LINES_H */
