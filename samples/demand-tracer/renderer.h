/** The scene on the device, and the pipeline or compute shader that traces it. */
#ifndef TRACER_RENDERER_H
#define TRACER_RENDERER_H

#include "accel.h"
#include "../common/film.h"
#include "needs.h"
#include "options.h"
#include "pipeline_compute.h"
#include "pipeline_rays.h"
#include "textures.h"

/** Zeroed is empty. */
struct renderer {
    bool uses_pipeline; ///< true: ray-tracing pipeline; false: compute shader
    struct gpu_buffer vertices, indices, instances, nodes;
    struct needs needs;
    struct accel accel;
    struct bindings bindings;
    struct ray_pipeline rays;
    VkPipeline compute;
    struct TracerLaunch constants; ///< push constants of the camera
};

/** Settings of a renderer. */
struct renderer_request {
    const struct tracer_options *options;
    const struct scene *scene;
    const struct textures *textures;
    const SluiceDemandTextureId *texture_ids; ///< ids of the loader
    const SluiceDemandLoader *loader;
    const struct film *film;
};

/** Reports errors on stderr, and the choice of path if it is the slower one. */
bool renderer_create(const struct gpu *gpu, const struct renderer_request *request,
                     struct renderer *renderer);
void renderer_destroy(const struct gpu *gpu, struct renderer *renderer);

/** Applies to launches recorded from now on. */
void renderer_set_camera(struct renderer *renderer, const struct tracer_options *options,
                         const struct scene_camera *camera);

/** Traces the film's missing pixels. Call between sluiceBeginDemandLaunch and
 * sluiceEndDemandLaunch. */
void renderer_record(struct renderer *renderer, VkDescriptorSet demand_set, const struct film *film,
                     uint32_t sample, VkCommandBuffer commands);

#endif /* TRACER_RENDERER_H */
