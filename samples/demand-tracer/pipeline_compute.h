/** The same paths in a compute shader, which goes down the hierarchies of bvh.h itself. */
#ifndef TRACER_PIPELINE_COMPUTE_H
#define TRACER_PIPELINE_COMPUTE_H

#include "bindings.h"

/** `needs`: notes what complete paths sample. `scene_root`: node over all instances. Says on stderr
 * why it failed. */
bool compute_pipeline_create(const struct gpu *gpu, VkPipelineLayout layout, bool preview,
                             bool needs, uint32_t scene_root, VkPipeline *pipeline);

/** Records a launch; the descriptor sets are bound. */
void compute_pipeline_record(VkPipeline pipeline, VkCommandBuffer commands, uint32_t pixel_count);

#endif /* TRACER_PIPELINE_COMPUTE_H */
