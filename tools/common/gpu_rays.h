/** Device features of the ray-tracing pipeline. */
#ifndef TOOLS_COMMON_GPU_RAYS_H
#define TOOLS_COMMON_GPU_RAYS_H

#include <vulkan/vulkan.h>

#include <stdbool.h>

struct gpu_ray_features {
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures;
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipelines;
};

/** Returns whether the device has the pipeline, acceleration structures and buffer addresses. */
bool gpu_traces_rays(VkPhysicalDevice device);
/** Adds features for device creation. `rays` becomes part of the chain. */
void gpu_require_rays(struct gpu_ray_features *rays, VkPhysicalDeviceVulkan12Features *vulkan12);
/** Device extensions of the features. */
#define GPU_RAY_EXTENSIONS 3
extern const char *const gpu_ray_extensions[GPU_RAY_EXTENSIONS];

#endif /* TOOLS_COMMON_GPU_RAYS_H */
