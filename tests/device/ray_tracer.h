/**
 * A floor over uv 0 to 1 and rays down onto it, whose closest-hit shader writes feedback. Needs
 * RAY_TRACER_EXTENSIONS and a harness that was made with them and ray_tracer_features.
 */
#ifndef TESTS_DEVICE_RAY_TRACER_H
#define TESTS_DEVICE_RAY_TRACER_H

#include "device/writer.h"

#define RAY_TRACER_EXTENSION_COUNT 3u
extern const char *const ray_tracer_extensions[RAY_TRACER_EXTENSION_COUNT];
/** A chain for harness_init_with; static. */
void *ray_tracer_features(void);

/* clang-format off */
#define RAY_TRACER_FUNCTIONS(X)                                                                    \
    X(CmdBuildAccelerationStructuresKHR) X(CmdTraceRaysKHR) X(CreateAccelerationStructureKHR)      \
    X(CreateRayTracingPipelinesKHR) X(DestroyAccelerationStructureKHR)                             \
    X(GetAccelerationStructureBuildSizesKHR) X(GetAccelerationStructureDeviceAddressKHR)           \
    X(GetBufferDeviceAddress) X(GetRayTracingShaderGroupHandlesKHR)
/* clang-format on */

/** Host visible, with an address. */
struct ray_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *mapped;
    VkDeviceAddress address;
};

struct ray_structure {
    struct ray_buffer storage, scratch;
    VkAccelerationStructureKHR handle;
};

struct ray_tracer {
    struct harness *h;
    struct writer *writer; ///< whose inputs are the rays: from uv, dx[0] high
    struct ray_buffer vertices, instances, shaders;
    struct ray_structure floor, scene;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkStridedDeviceAddressRegionKHR groups[3]; ///< rays begin, miss, hit
    float cone_angle;
#define RAY_TRACER_MEMBER(name) PFN_vk##name name;
    RAY_TRACER_FUNCTIONS(RAY_TRACER_MEMBER)
#undef RAY_TRACER_MEMBER
};

void ray_tracer_init(struct ray_tracer *r, struct harness *h, struct writer *writer);
void ray_tracer_finish(struct ray_tracer *r);

/** For harness_frame: writer->count rays; user is the tracer. */
void ray_tracer_record(void *user, VkCommandBuffer commands);

#endif /* TESTS_DEVICE_RAY_TRACER_H */
