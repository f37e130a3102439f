#include "devices.h"

#include "../common/no_vulkan.h"
#include "../common/text.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#ifdef _WIN32
#define LIBRARY "vulkan-1.dll"
#else
#define LIBRARY "libvulkan.so.1"
#endif

static PFN_vkVoidFunction find(const struct devices *d, const char *name)
{
    return d->get(d->instance, name);
}

static bool create_instance(struct devices *d)
{
    PFN_vkCreateInstance create = (PFN_vkCreateInstance)find(d, "vkCreateInstance");
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .pApplicationName = "sluice-info",
                                     .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    VkResult result = create ? create(&info, NULL, &d->instance) : VK_ERROR_INITIALIZATION_FAILED;
    if (result == VK_SUCCESS)
        return true;
    d->instance = VK_NULL_HANDLE;
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        text_say("sluice-info: %s", NO_VULKAN_DRIVER);
    else
        text_say("sluice-info: Vulkan does not start (vkCreateInstance: %d)", result);
    return false;
}

bool open_devices(struct devices *d)
{
    *d = (struct devices){0};
    d->library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (d->library)
        *(void **)&d->get =
            dlsym(d->library, "vkGetInstanceProcAddr"); /* the conversion that POSIX recommends */
    if (!d->get) {
        text_say("sluice-info: the Vulkan loader is not installed: %s", dlerror());
        return false;
    }
    if (!create_instance(d))
        return false;
    PFN_vkEnumeratePhysicalDevices enumerate =
        (PFN_vkEnumeratePhysicalDevices)find(d, "vkEnumeratePhysicalDevices");
    d->count = MAX_DEVICES;
    VkResult result = enumerate(d->instance, &d->count, d->devices);
    if (result >= 0 && d->count > 0)
        return true;
    text_say("sluice-info: %s", NO_VULKAN_DRIVER);
    close_devices(d);
    return false;
}

void close_devices(struct devices *d)
{
    if (d->instance)
        ((PFN_vkDestroyInstance)find(d, "vkDestroyInstance"))(d->instance, NULL);
    /* The loader stays loaded: threads of drivers may outlive an unload and crash. */
    *d = (struct devices){0};
}

/* Keeps the last message, which says why. */
static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)severity;
    snprintf(user, MAX_REASON, "%s", message);
}

/* Leaves `missing` empty if the device supports the mode. */
static void ask_mode(const struct devices *d, VkPhysicalDevice physical, enum format_mode mode,
                     char missing[MAX_REASON])
{
    SluiceLogCallback log = {missing, on_log};
    VkPhysicalDeviceFeatures features = {0};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    SluiceResult result = sluiceRequireVulkanFeatures(
        d->instance, physical, d->get, format_mode_residency(mode), &log, &features, &vulkan12);
    if (result == SLUICE_SUCCESS)
        missing[0] = '\0';
    else if (!missing[0])
        snprintf(missing, MAX_REASON, "%s", sluiceGetResultName(result));
}

static VkDevice create_device(const struct devices *d, struct device_report *report)
{
    VkPhysicalDevice physical = d->devices[report->index];
    SluiceLogCallback log = {report->missing, on_log};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    if (sluiceRequireVulkanFeatures(d->instance, physical, d->get, SLUICE_RESIDENCY_MODE_SPARSE,
                                    &log, &features.features, &vulkan12) != SLUICE_SUCCESS)
        return VK_NULL_HANDLE;
    float priority = 1.0f;
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueFamilyIndex =
                                         report->capabilities.sparseQueueFamilyIndex,
                                     .queueCount = 1,
                                     .pQueuePriorities = &priority};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = &features,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue};
    PFN_vkCreateDevice create = (PFN_vkCreateDevice)find(d, "vkCreateDevice");
    VkDevice device;
    VkResult result = create(physical, &info, NULL, &device);
    if (result == VK_SUCCESS)
        return device;
    snprintf(report->missing, sizeof report->missing, "vkCreateDevice failed with %d", result);
    return VK_NULL_HANDLE;
}

static void ask_format(const struct devices *d, VkDevice device, SluiceFormat format,
                       struct device_report *report)
{
    VkPhysicalDevice physical = d->devices[report->index];
    struct format_report *f = &report->formats[format];
    f->capabilities.structSize = sizeof f->capabilities;
    f->layout.structSize = sizeof f->layout;
    if (sluiceGetVulkanFormatCapabilities(d->instance, physical, d->get, format,
                                          &f->capabilities) != SLUICE_SUCCESS)
        return;
    SluiceImageInfo image = {sizeof image, report->width, report->height, 0, format, "probe"};
    f->has_layout = device && f->capabilities.sparse &&
                    sluiceGetVulkanSparseImageLayout(d->instance, physical, device, d->get, NULL,
                                                     &image, &f->layout) == SLUICE_SUCCESS;
}

bool ask_device(const struct devices *d, uint32_t index, uint32_t width, uint32_t height,
                struct device_report *report)
{
    *report = (struct device_report){.index = index, .width = width, .height = height};
    report->capabilities.structSize = sizeof report->capabilities;
    SluiceResult result = sluiceGetVulkanDeviceCapabilities(d->instance, d->devices[index], d->get,
                                                            &report->capabilities);
    if (result != SLUICE_SUCCESS) {
        text_say("sluice-info: device %u does not answer: %s", index, sluiceGetResultName(result));
        return false;
    }
    for (uint32_t m = 0; m < FORMAT_MODES; m++)
        ask_mode(d, d->devices[index], (enum format_mode)m, report->missing_for[m]);
    VkDevice device = create_device(d, report);
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++)
        ask_format(d, device, (SluiceFormat)f, report);
    if (device)
        ((PFN_vkDestroyDevice)find(d, "vkDestroyDevice"))(device, NULL);
    return true;
}
