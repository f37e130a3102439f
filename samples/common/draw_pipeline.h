/** A graphics pipeline for the samples: triangles with a depth test. */
#ifndef SAMPLES_COMMON_DRAW_PIPELINE_H
#define SAMPLES_COMMON_DRAW_PIPELINE_H

#include "../../tools/common/gpu.h"
#include "../../tools/common/target.h"

struct draw_pipeline_info {
    const struct target *target; ///< viewport and scissor are dynamic
    VkPipelineLayout layout;
    VkShaderModule vertex, fragment;
    const VkSpecializationInfo *constants;             ///< of the fragment shader; may be NULL
    const VkPipelineVertexInputStateCreateInfo *input; ///< NULL: the vertex shader reads none
    VkCullModeFlags culled;
    bool blended;  ///< by the color's alpha, and writes no depth
    bool lines;    ///< lists of lines instead of triangles
    bool no_color; ///< writes depth, and buffers of the shader, but no color
};

/** Creates the pipeline. If it returns false, it has printed why on stderr. */
bool draw_pipeline_create(const struct gpu *gpu, const struct draw_pipeline_info *info,
                          VkPipeline *pipeline);

#endif /* SAMPLES_COMMON_DRAW_PIPELINE_H */
