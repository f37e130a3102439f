/** Traces paths in a compute shader, which walks the trees of bvh.h itself. */
#ifndef TRACER_PIPELINE_COMPUTE_H
#define TRACER_PIPELINE_COMPUTE_H

#include "bindings.h"

/** `needs`: note the pages that complete paths sample. `scene_root`: node over all instances.
 * Reports errors on stderr. */
bool compute_pipeline_create(const struct gpu *gpu, VkPipelineLayout layout, bool preview,
                             bool needs, uint32_t scene_root, VkPipeline *pipeline);

/** Records a launch. Bind the descriptor sets before. */
void compute_pipeline_record(VkPipeline pipeline, VkCommandBuffer commands, uint32_t pixel_count);

#endif /* TRACER_PIPELINE_COMPUTE_H */
