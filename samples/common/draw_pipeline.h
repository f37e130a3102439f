/** A graphics pipeline as the samples draw: triangles, opaque, the nearest one wins. */
#ifndef SAMPLES_COMMON_DRAW_PIPELINE_H
#define SAMPLES_COMMON_DRAW_PIPELINE_H

#include "../../tools/common/gpu.h"
#include "../../tools/common/target.h"

struct draw_pipeline_info {
    const struct target *target; ///< viewport and scissor are dynamic
    VkPipelineLayout layout;
    VkShaderModule vertex, fragment;
    const VkPipelineVertexInputStateCreateInfo *input; ///< NULL: the vertex shader reads none
    VkCullModeFlags culled;
    bool no_color; ///< only depth is written, and what the shader writes to buffers
};

/** Says on stderr why it failed. */
bool draw_pipeline_create(const struct gpu *gpu, const struct draw_pipeline_info *info,
                          VkPipeline *pipeline);

#endif /* SAMPLES_COMMON_DRAW_PIPELINE_H */
