/** Creates graphics pipelines for the samples: triangles with a depth test. */
#ifndef SAMPLES_COMMON_DRAW_PIPELINE_H
#define SAMPLES_COMMON_DRAW_PIPELINE_H

#include "../../tools/common/gpu.h"
#include "../../tools/common/target.h"

struct draw_pipeline_info {
    const struct target *target; ///< the pipeline's viewport and scissor are dynamic
    VkPipelineLayout layout;
    VkShaderModule vertex, fragment;
    const VkSpecializationInfo *constants;             ///< for the fragment shader; may be NULL
    const VkPipelineVertexInputStateCreateInfo *input; ///< NULL: no vertex input
    VkCullModeFlags culled;
    bool blended;  ///< blend by the color's alpha; do not write depth
    bool lines;    ///< draw lists of lines instead of triangles
    bool no_color; ///< write depth and the shader's buffers, but no color
};

/** Creates the pipeline. Reports errors on stderr. */
bool draw_pipeline_create(const struct gpu *gpu, const struct draw_pipeline_info *info,
                          VkPipeline *pipeline);

#endif /* SAMPLES_COMMON_DRAW_PIPELINE_H */
