/** The scene on the device, and the path that traces it. */
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
    bool uses_pipeline; ///< for ray tracing; else the compute path
    struct gpu_buffer vertices, indices, instances, nodes;
    struct needs needs;
    struct accel accel;
    struct bindings bindings;
    struct ray_pipeline rays;
    VkPipeline compute;
    struct TracerLaunch constants; ///< of the camera
};

/** Settings of a renderer. */
struct renderer_request {
    const struct tracer_options *options;
    const struct scene *scene;
    const struct textures *textures;
    const SluiceDemandTextureId *texture_ids; ///< of the loader
    const SluiceDemandLoader *loader;
    const struct film *film;
};

/** Says on stderr why it failed, and which path it is if that is not the faster one. */
bool renderer_create(const struct gpu *gpu, const struct renderer_request *request,
                     struct renderer *renderer);
void renderer_destroy(const struct gpu *gpu, struct renderer *renderer);

/** For the launches that are recorded from now on. */
void renderer_set_camera(struct renderer *renderer, const struct tracer_options *options,
                         const struct scene_camera *camera);

/** Between sluiceBeginDemandLaunch and sluiceEndDemandLaunch: traces what the film still misses.
 */
void renderer_record(struct renderer *renderer, VkDescriptorSet demand_set, const struct film *film,
                     uint32_t sample, VkCommandBuffer commands);

#endif /* TRACER_RENDERER_H */
