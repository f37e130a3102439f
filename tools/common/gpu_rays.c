#include "gpu_rays.h"

#include <stdlib.h>
#include <string.h>

const char *const gpu_ray_extensions[GPU_RAY_EXTENSIONS] = {
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

static bool has_extension(VkPhysicalDevice device, const char *name)
{
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, NULL, &count, NULL);
    VkExtensionProperties *extensions = calloc(count ? count : 1, sizeof *extensions);
    bool found = false;
    if (extensions)
        vkEnumerateDeviceExtensionProperties(device, NULL, &count, extensions);
    for (uint32_t i = 0; extensions && i < count; i++)
        found = found || strcmp(extensions[i].extensionName, name) == 0;
    free(extensions);
    return found;
}

bool gpu_traces_rays(VkPhysicalDevice device)
{
    for (size_t i = 0; i < GPU_RAY_EXTENSIONS; i++)
        if (!has_extension(device, gpu_ray_extensions[i]))
            return false;
    struct gpu_ray_features rays = {
        {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR},
        {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR}};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &rays.structures};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    rays.structures.pNext = &rays.pipelines;
    vkGetPhysicalDeviceFeatures2(device, &features);
    return rays.structures.accelerationStructure && rays.pipelines.rayTracingPipeline &&
           vulkan12.bufferDeviceAddress;
}

void gpu_require_rays(struct gpu_ray_features *rays, VkPhysicalDeviceVulkan12Features *vulkan12)
{
    *rays = (struct gpu_ray_features){
        {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
         .pNext = &rays->pipelines,
         .accelerationStructure = VK_TRUE},
        {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR,
         .rayTracingPipeline = VK_TRUE}};
    vulkan12->pNext = &rays->structures;
    vulkan12->bufferDeviceAddress = VK_TRUE;
}
