/** The device's own ray-tracing pipeline: paths begin, go on, and look at what they hit. */
#ifndef TRACER_PIPELINE_RAYS_H
#define TRACER_PIPELINE_RAYS_H

#include "../common/ray_table.h"
#include "bindings.h"

/** Zeroed is empty. */
struct ray_pipeline {
    VkPipeline pipeline;
    struct ray_table table;
};

/** `needs`: notes what complete paths sample. Says on stderr why it failed. */
bool ray_pipeline_create(const struct gpu *gpu, VkPipelineLayout layout, bool preview, bool needs,
                         struct ray_pipeline *pipeline);
void ray_pipeline_destroy(const struct gpu *gpu, struct ray_pipeline *pipeline);

/** Records a launch; the descriptor sets are bound. */
void ray_pipeline_record(const struct ray_pipeline *pipeline, VkCommandBuffer commands,
                         uint32_t pixel_count);

#endif /* TRACER_PIPELINE_RAYS_H */
