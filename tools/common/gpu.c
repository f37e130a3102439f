#include "gpu.h"

#include "gpu_queues.h"
#include "gpu_rays.h"
#include "log.h"
#include "no_vulkan.h"
#include "text.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_DEVICES 32
#define MAX_FAMILIES 32
#define MAX_WINDOW_EXTENSIONS 8
#define VALIDATION_LAYER "VK_LAYER_KHRONOS_validation"

static const char *vulkan_result_string(VkResult result)
{
    switch ((int)result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY: return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED: return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST: return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_LAYER_NOT_PRESENT: return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT: return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT: return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER: return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_TIMEOUT: return "VK_TIMEOUT";
    default: return "an unexpected VkResult";
    }
}

bool gpu_check(VkResult result, const char *what)
{
    if (result == VK_SUCCESS)
        return true;
    fprintf(stderr, "%s: %s (%d)\n", what, vulkan_result_string(result), (int)result);
    return false;
}

static VKAPI_ATTR VkBool32 VKAPI_CALL note_validation_message(
    VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
    const VkDebugUtilsMessengerCallbackDataEXT *data, void *user_data)
{
    struct gpu *gpu = user_data;
    (void)types;
    atomic_fetch_add(&gpu->validation_messages, 1);
    fprintf(stderr, "validation %s: %s\n",
            severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? "error" : "warning",
            data->pMessage);
    return VK_FALSE;
}

static VkDebugUtilsMessengerCreateInfoEXT messenger_info(struct gpu *gpu)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        /* Leave out hints on speed: streamed images stay in the GENERAL layout on purpose. */
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = note_validation_message,
        .pUserData = gpu,
    };
}

/** `*no_driver` tells a machine without any Vulkan driver from other failures. */
static bool create_instance(const struct gpu_request *request, struct gpu *gpu, bool *no_driver)
{
    static const VkValidationFeatureEnableEXT synchronization[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    static const char *const layers[] = {VALIDATION_LAYER};
    const char *extensions[2 + MAX_WINDOW_EXTENSIONS] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                                         VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const bool validation = request->validation;
    const uint32_t first = validation ? 0 : 2;
    uint32_t end = 2;
    gpu->borrows_instance = request->first != NULL;
    if (request->first) {
        gpu->instance = request->first->instance;
        return true;
    }
    for (; end < 2 + request->instance_extension_count && end < 2 + MAX_WINDOW_EXTENSIONS; end++)
        extensions[end] = request->instance_extensions[end - 2];

    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(gpu);
    VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                        .pNext = &messenger,
                                        .enabledValidationFeatureCount = 1,
                                        .pEnabledValidationFeatures = synchronization};
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .pApplicationName = "sluice samples",
                                     .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application,
                                 .enabledExtensionCount = end - first,
                                 .ppEnabledExtensionNames = extensions + first};
    if (validation) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = layers;
    }
    VkResult result = vkCreateInstance(&info, NULL, &gpu->instance);
    *no_driver = result == VK_ERROR_INCOMPATIBLE_DRIVER;
    if (*no_driver) {
        fprintf(stderr, "%s\n", NO_VULKAN_DRIVER);
        return false;
    }
    if (!gpu_check(result, "vkCreateInstance"))
        return false;
    if (!validation)
        return true;
    PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(gpu->instance,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    messenger.pNext = NULL;
    return create && gpu_check(create(gpu->instance, &messenger, NULL, &gpu->messenger),
                               "vkCreateDebugUtilsMessengerEXT");
}

static uint32_t enumerate_devices(VkInstance instance, VkPhysicalDevice devices[MAX_DEVICES])
{
    uint32_t count = MAX_DEVICES;
    VkResult result = vkEnumeratePhysicalDevices(instance, &count, devices);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE)
        count = 0;
    if (count == 0)
        fprintf(stderr, "%s\n", NO_VULKAN_DRIVER);
    return count;
}

static const char *device_type_string(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "CPU";
    default: return "other";
    }
}

static SluiceResidencyMode choose_mode(const SluiceVulkanDeviceCapabilities *capabilities,
                                       SluiceResidencyMode mode, uint32_t texture_count)
{
    sluiceChooseVulkanResidencyMode(capabilities, mode, texture_count, &mode);
    return mode;
}

/** The shaders of samples find pages by non-uniform indices. */
static bool can_stream(VkInstance instance, VkPhysicalDevice device, SluiceResidencyMode mode,
                       SluiceVulkanDeviceCapabilities *capabilities)
{
    VkPhysicalDeviceFeatures features = {0};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    return sluiceGetVulkanDeviceCapabilities(instance, device, vkGetInstanceProcAddr,
                                             capabilities) == SLUICE_SUCCESS &&
           (choose_mode(capabilities, mode, 0) != SLUICE_RESIDENCY_MODE_PAGED ||
            capabilities->nonUniformIndexing) &&
           sluiceRequireVulkanFeatures(instance, device, vkGetInstanceProcAddr, mode, NULL,
                                       &features, &vulkan12) == SLUICE_SUCCESS;
}

uint32_t gpu_list_devices(void)
{
    struct gpu gpu = {0};
    bool no_driver;
    if (!create_instance(&(struct gpu_request){0}, &gpu, &no_driver))
        return 0;
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t count = enumerate_devices(gpu.instance, devices);
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        SluiceVulkanDeviceCapabilities capabilities = {.structSize = sizeof capabilities};
        printf("%u  %s (%s, Vulkan %u.%u): %s\n", i, properties.deviceName,
               device_type_string(properties.deviceType),
               VK_API_VERSION_MAJOR(properties.apiVersion),
               VK_API_VERSION_MINOR(properties.apiVersion),
               can_stream(gpu.instance, devices[i], SLUICE_RESIDENCY_MODE_SPARSE, &capabilities)
                   ? "sparse residency"
                   : "no sparse residency");
    }
    gpu_destroy(&gpu);
    return count;
}

void gpu_print_json(const struct gpu *gpu)
{
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vkGetPhysicalDeviceProperties2(gpu->physical_device, &properties);
    printf("{\"name\": \"device\", \"value\": ");
    text_write_json(stdout, gpu->properties.deviceName);
    printf(", \"unit\": \"\"}\n{\"name\": \"driver\", \"value\": ");
    text_write_json(stdout, driver.driverInfo[0] ? driver.driverInfo : driver.driverName);
    printf(", \"unit\": \"\"}\n");
}

static bool contains_ignoring_case(const char *text, const char *part)
{
    size_t length = strlen(part);
    for (; *text; text++) {
        size_t i = 0;
        while (i < length && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            i++;
        if (i == length)
            return true;
    }
    return length == 0;
}

/** By a part of its name or of its type: "cpu" finds lavapipe. */
static bool is_called(const VkPhysicalDeviceProperties *properties, const char *wanted)
{
    return contains_ignoring_case(properties->deviceName, wanted) ||
           contains_ignoring_case(device_type_string(properties->deviceType), wanted);
}

static int device_rank(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return 1;
    default: return 0;
    }
}

/** The device that was asked for, or the best that streams. */
static bool choose_device(const char *wanted, struct gpu *gpu)
{
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t count = enumerate_devices(gpu->instance, devices);
    char *end = NULL;
    unsigned long wanted_index = wanted ? strtoul(wanted, &end, 10) : 0;
    bool by_index = wanted && *wanted && *end == '\0';

    int best_rank = -1;
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (by_index ? i != wanted_index : wanted && !is_called(&properties, wanted))
            continue;
        SluiceVulkanDeviceCapabilities capabilities = {.structSize = sizeof capabilities};
        if (!can_stream(gpu->instance, devices[i], gpu->modes[0], &capabilities) ||
            !can_stream(gpu->instance, devices[i], gpu->modes[1], &capabilities))
            continue;
        if (device_rank(properties.deviceType) <= best_rank)
            continue;
        best_rank = device_rank(properties.deviceType);
        gpu->physical_device = devices[i];
        gpu->properties = properties;
        gpu->capabilities = capabilities;
    }
    gpu->is_auto = gpu->modes[0] == SLUICE_RESIDENCY_MODE_AUTO;
    gpu->modes[0] = choose_mode(&gpu->capabilities, gpu->modes[0], 0);
    if (gpu->modes[1] == SLUICE_RESIDENCY_MODE_AUTO)
        gpu->modes[1] = gpu->modes[0] == SLUICE_RESIDENCY_MODE_SPARSE ? SLUICE_RESIDENCY_MODE_SPARSE
                                                                      : SLUICE_RESIDENCY_MODE_DENSE;
    if (by_index && wanted_index >= count && count > 0)
        text_say("there is no device %s; --list-devices lists %u", wanted, count);
    else if (best_rank < 0 && count > 0)
        text_say("no Vulkan device%s%s %s", wanted ? " like " : "", wanted ? wanted : "",
                 !gpu->is_auto && gpu->modes[0] == SLUICE_RESIDENCY_MODE_SPARSE ? CANNOT_STREAM
                                                                                : LACKS_FEATURES);
    return best_rank >= 0;
}

uint32_t gpu_list_alike(const struct gpu *gpu, const struct device_list *list,
                        uint32_t indices[DEVICE_LIST_MOST])
{
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t found = 0;
    const uint32_t count = enumerate_devices(gpu->instance, devices);
    if (list->wanted == 0) {
        memcpy(indices, list->indices, list->count * sizeof *indices);
        return list->count;
    }
    for (uint32_t i = 0; i < count && found < list->wanted; i++) {
        VkPhysicalDeviceProperties properties;
        SluiceVulkanDeviceCapabilities capabilities = {.structSize = sizeof capabilities};
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (properties.deviceType == gpu->properties.deviceType &&
            can_stream(gpu->instance, devices[i], gpu->modes[0], &capabilities) &&
            can_stream(gpu->instance, devices[i], gpu->modes[1], &capabilities))
            indices[found++] = i;
    }
    if (list->wanted == DEVICE_LIST_ALL || found == list->wanted)
        return found;
    text_say("%u devices of a type are wanted, and %u are there: %s", list->wanted, found,
             device_type_string(gpu->properties.deviceType));
    return 0;
}

static bool choose_queue_family(struct gpu *gpu)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    vkGetPhysicalDeviceQueueFamilyProperties(gpu->physical_device, &count, families);
    const VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; i++)
        if ((families[i].queueFlags & needed) == needed) {
            gpu->family = i;
            gpu->sparse_family =
                gpu->capabilities.sparse ? gpu->capabilities.sparseQueueFamilyIndex : gpu->family;
            return true;
        }
    fprintf(stderr, "%s has no graphics queue\n", gpu->properties.deviceName);
    return false;
}

static bool has_addresses(VkPhysicalDevice device)
{
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    vkGetPhysicalDeviceFeatures2(device, &features);
    return vulkan12.bufferDeviceAddress;
}

/** Returns the index of the queue for builds in its family. */
static uint32_t choose_queues(struct gpu *gpu, struct gpu_queue_list *queues)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    vkGetPhysicalDeviceQueueFamilyProperties(gpu->physical_device, &count, families);
    gpu_queue_add(queues, families, gpu->family);
    if (gpu->sparse_family != gpu->family)
        gpu_queue_add(queues, families, gpu->sparse_family);
    gpu->build_family = gpu->family;
    return gpu->has_build_queue ? gpu_queue_add_builder(queues, families, count, gpu) : 0;
}

static bool create_device(const struct gpu_request *request, struct gpu *gpu)
{
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    VkPhysicalDeviceFeatures supported;
    vkGetPhysicalDeviceFeatures(gpu->physical_device, &supported);
    features.features.samplerAnisotropy = supported.samplerAnisotropy;
    features.features.shaderResourceResidency = supported.shaderResourceResidency;
    features.features.shaderStorageImageExtendedFormats =
        supported.shaderStorageImageExtendedFormats;
    features.features.fragmentStoresAndAtomics = VK_TRUE;

    SluiceLogCallback log = {.pfnLog = log_say};
    for (int i = 0; i < 2; i++)
        if (sluiceRequireVulkanFeatures(gpu->instance, gpu->physical_device, vkGetInstanceProcAddr,
                                        i == 0 && gpu->is_auto ? SLUICE_RESIDENCY_MODE_AUTO
                                                               : gpu->modes[i],
                                        &log, &features.features, &vulkan12) != SLUICE_SUCCESS)
            return false;

    for (int i = 0; request->every_mode && i < 3; i++) { /* without features: nothing changes */
        static const SluiceResidencyMode modes[] = {
            SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};
        sluiceRequireVulkanFeatures(gpu->instance, gpu->physical_device, vkGetInstanceProcAddr,
                                    modes[i], NULL, &features.features, &vulkan12);
    }
    if (gpu->byte_pages) {
        if (sluiceRequireVulkanFeatures(gpu->instance, gpu->physical_device, vkGetInstanceProcAddr,
                                        SLUICE_RESIDENCY_MODE_PAGED, &log, &features.features,
                                        &vulkan12) != SLUICE_SUCCESS)
            return false;
        vulkan12.bufferDeviceAddress = VK_TRUE;
    }

    struct gpu_queue_list queues = {0};
    const uint32_t build_index = choose_queues(gpu, &queues);
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = &features,
                               .queueCreateInfoCount = queues.count,
                               .pQueueCreateInfos = queues.infos};
    const char *extensions[GPU_RAY_EXTENSIONS + 1];
    struct gpu_ray_features rays;
    info.ppEnabledExtensionNames = extensions;
    if (gpu->presents)
        extensions[info.enabledExtensionCount++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    if (gpu->ray_tracing)
        gpu_require_rays(&rays, &vulkan12);
    for (int i = 0; gpu->ray_tracing && i < GPU_RAY_EXTENSIONS; i++)
        extensions[info.enabledExtensionCount++] = gpu_ray_extensions[i];
    if (gpu->buffer_addresses)
        vulkan12.bufferDeviceAddress = VK_TRUE;
    SluiceNeuralPathFeatures paths;
    if (gpu->neural.structSize) {
        if (sluiceRequireNeuralPaths(&gpu->neural, vulkan12.pNext, &vulkan12, &paths) !=
            SLUICE_SUCCESS)
            return false;
        vulkan12.pNext = paths.pNext;
        info.enabledExtensionCount = paths.extensionCount;
        info.ppEnabledExtensionNames = paths.extensions;
    }
    if (!gpu_check(vkCreateDevice(gpu->physical_device, &info, NULL, &gpu->device),
                   "vkCreateDevice"))
        return false;
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    if (gpu->capabilities.sparse)
        vkGetDeviceQueue(gpu->device, gpu->sparse_family, 0, &gpu->sparse_queue);
    vkGetDeviceQueue(gpu->device, gpu->build_family, build_index, &gpu->build_queue);
    gpu->has_build_queue = gpu->build_queue != gpu->queue;
    vkGetPhysicalDeviceMemoryProperties(gpu->physical_device, &gpu->memory);

    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = gpu->family};
    return gpu_check(vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->command_pool),
                     "vkCreateCommandPool");
}

bool gpu_create(const struct gpu_request *request, struct gpu *gpu, bool *unsupported)
{
    memset(gpu, 0, sizeof *gpu);
    memcpy(gpu->modes, request->modes, sizeof gpu->modes);
    gpu->presents = request->instance_extension_count > 0;
    if (create_instance(request, gpu, unsupported)) {
        *unsupported = !choose_device(request->device, gpu) || !choose_queue_family(gpu);
        gpu->ray_tracing =
            !*unsupported && request->ray_tracing && gpu_traces_rays(gpu->physical_device);
        gpu->buffer_addresses = gpu->ray_tracing || (!*unsupported && request->buffer_addresses &&
                                                     has_addresses(gpu->physical_device));
        gpu->has_build_queue = request->build_queue;
        gpu->byte_pages =
            !*unsupported && request->byte_pages && has_addresses(gpu->physical_device) &&
            can_stream(gpu->instance, gpu->physical_device, SLUICE_RESIDENCY_MODE_PAGED,
                       &(SluiceVulkanDeviceCapabilities){.structSize = sizeof gpu->capabilities});
        if (!*unsupported && request->neural && !gpu->ray_tracing) {
            gpu->neural.structSize = sizeof gpu->neural;
            *unsupported =
                sluiceGetNeuralPaths(gpu->instance, gpu->physical_device, vkGetInstanceProcAddr,
                                     NULL, &gpu->neural) != SLUICE_SUCCESS;
        }
        if (!*unsupported && create_device(request, gpu))
            return true;
    }
    gpu_destroy(gpu);
    return false;
}

void gpu_choose_mode(struct gpu *gpu, uint32_t texture_count)
{
    if (gpu->is_auto && gpu->capabilities.nonUniformIndexing)
        gpu->modes[0] = choose_mode(&gpu->capabilities, SLUICE_RESIDENCY_MODE_AUTO, texture_count);
}

void gpu_destroy(struct gpu *gpu)
{
    if (gpu->device) {
        vkDeviceWaitIdle(gpu->device);
        vkDestroyCommandPool(gpu->device, gpu->command_pool, NULL);
        vkDestroyDevice(gpu->device, NULL);
    }
    if (gpu->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                gpu->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(gpu->instance, gpu->messenger, NULL);
    }
    if (gpu->instance && !gpu->borrows_instance)
        vkDestroyInstance(gpu->instance, NULL);
    gpu->device = VK_NULL_HANDLE;
    gpu->messenger = VK_NULL_HANDLE;
    gpu->instance = VK_NULL_HANDLE;
}

VkShaderModule gpu_create_shader(const struct gpu *gpu, const uint32_t *words, size_t size)
{
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = words};
    VkShaderModule module = VK_NULL_HANDLE;
    gpu_check(vkCreateShaderModule(gpu->device, &info, NULL, &module), "vkCreateShaderModule");
    return module;
}

static bool create_compute_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                    const uint32_t *words, size_t size,
                                    const VkSpecializationInfo *constants,
                                    VkPipelineShaderStageCreateFlags flags, VkPipeline *pipeline)
{
    VkShaderModule module = gpu_create_shader(gpu, words, size);
    if (!module)
        return false;
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .flags = flags,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = constants},
        .layout = layout};
    bool created =
        gpu_check(vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, pipeline),
                  "vkCreateComputePipelines");
    vkDestroyShaderModule(gpu->device, module, NULL);
    return created;
}

bool gpu_create_compute_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                 const uint32_t *words, size_t size,
                                 const VkSpecializationInfo *constants, VkPipeline *pipeline)
{
    return create_compute_pipeline(gpu, layout, words, size, constants, 0, pipeline);
}

bool gpu_create_subgroup_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                  const uint32_t *words, size_t size,
                                  const VkSpecializationInfo *constants, VkPipeline *pipeline)
{
    return create_compute_pipeline(gpu, layout, words, size, constants,
                                   VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT_EXT,
                                   pipeline);
}

void gpu_barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags from_access,
                 VkPipelineStageFlags to, VkAccessFlags to_access)
{
    VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                              .srcAccessMask = from_access,
                              .dstAccessMask = to_access};
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, NULL, 0, NULL);
}
