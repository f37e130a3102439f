/**
 * A floor over uv 0 to 1, with rays down onto it. The closest-hit shader writes feedback. Requires
 * a harness created with ray_device_extensions and ray_device_features.
 */
#ifndef TESTS_DEVICE_RAY_TRACER_H
#define TESTS_DEVICE_RAY_TRACER_H

#include "device/ray_structures.h"
#include "device/writer.h"

struct ray_tracer {
    struct harness *h;
    struct ray_device device;
    struct writer *writer; ///< its inputs are the rays: from uv, at height dx[0]
    struct ray_buffer vertices, instances, shaders;
    struct ray_structure floor, scene;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkStridedDeviceAddressRegionKHR groups[3]; ///< rays begin, miss, hit
    float cone_angle;
};

void ray_tracer_init(struct ray_tracer *r, struct harness *h, struct writer *writer);
void ray_tracer_finish(struct ray_tracer *r);

/** Callback of harness_frame for writer->count rays; `user` is the tracer. */
void ray_tracer_record(void *user, VkCommandBuffer commands);

#endif /* TESTS_DEVICE_RAY_TRACER_H */
