/** What the ray-tracing pipeline needs of a device. */
#ifndef TOOLS_COMMON_GPU_RAYS_H
#define TOOLS_COMMON_GPU_RAYS_H

#include <vulkan/vulkan.h>

#include <stdbool.h>

struct gpu_ray_features {
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures;
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipelines;
};

/** Whether the device has the pipeline, acceleration structures and buffer addresses. */
bool gpu_traces_rays(VkPhysicalDevice device);
/** Adds features to what a device is created with; `rays` is part of the chain. */
void gpu_require_rays(struct gpu_ray_features *rays, VkPhysicalDeviceVulkan12Features *vulkan12);
/** The extensions of the device that the features need. */
#define GPU_RAY_EXTENSIONS 3
extern const char *const gpu_ray_extensions[GPU_RAY_EXTENSIONS];

#endif /* TOOLS_COMMON_GPU_RAYS_H */
