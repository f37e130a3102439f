/** Ray-tracing pipeline of the device. */
#ifndef TRACER_PIPELINE_RAYS_H
#define TRACER_PIPELINE_RAYS_H

#include "../common/ray_table.h"
#include "bindings.h"

/** Zeroed is empty. */
struct ray_pipeline {
    VkPipeline pipeline;
    struct ray_table table;
};

/** `needs`: record what complete paths sample. Reports errors on stderr. */
bool ray_pipeline_create(const struct gpu *gpu, VkPipelineLayout layout, bool preview, bool needs,
                         struct ray_pipeline *pipeline);
void ray_pipeline_destroy(const struct gpu *gpu, struct ray_pipeline *pipeline);

/** Records a launch. Bind the descriptor sets before. */
void ray_pipeline_record(const struct ray_pipeline *pipeline, VkCommandBuffer commands,
                         uint32_t pixel_count);

#endif /* TRACER_PIPELINE_RAYS_H */
