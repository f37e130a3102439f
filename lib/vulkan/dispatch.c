#include "vulkan/dispatch.h"

#include "base/log.h"

#include <stdio.h>
#include <string.h>

/* Loaders and drivers hide functions newer than the version that the instance was created for. */
static bool is_of_vulkan_1_0(const char *function)
{
    static const char *const newer[] = {"vkGetPhysicalDeviceFeatures2",
                                        "vkGetPhysicalDeviceProperties2",
                                        "vkGetSemaphoreCounterValue", "vkWaitSemaphores"};
    for (size_t i = 0; i < sizeof newer / sizeof newer[0]; i++)
        if (strcmp(function, newer[i]) == 0)
            return false;
    return true;
}

static void log_missing(const struct slc_vk *vk, const char *of, const char *function)
{
    slc_log(&vk->log, SLUICE_LOG_ERROR, "the Vulkan %s has no %s%s", of, function,
            is_of_vulkan_1_0(function) ? ""
                                       : ": create the instance with apiVersion 1.2 "
                                         "(VkApplicationInfo), and choose a device of Vulkan 1.2");
}

SluiceResult slc_vk_init_instance(struct slc_vk *vk, VkInstance instance,
                                  VkPhysicalDevice physical_device, PFN_vkGetInstanceProcAddr get,
                                  const SluiceLogCallback *log)
{
    *vk = (struct slc_vk){.instance = instance, .physical_device = physical_device};
    if (log)
        vk->log = *log;
#define LOAD(name)                                                                                 \
    vk->name = (PFN_vk##name)get(instance, "vk" #name);                                            \
    if (!vk->name) {                                                                               \
        log_missing(vk, "instance", "vk" #name);                                                   \
        return SLUICE_ERROR_UNSUPPORTED;                                                           \
    }
    SLC_VK_INSTANCE_FUNCTIONS(LOAD)
#undef LOAD
    return SLUICE_SUCCESS;
}

SluiceResult slc_vk_init_device(struct slc_vk *vk, VkDevice device)
{
    vk->device = device;
#define LOAD(name)                                                                                 \
    vk->name = (PFN_vk##name)vk->GetDeviceProcAddr(device, "vk" #name);                            \
    if (!vk->name) {                                                                               \
        log_missing(vk, "device", "vk" #name);                                                     \
        return SLUICE_ERROR_UNSUPPORTED;                                                           \
    }
    SLC_VK_DEVICE_FUNCTIONS(LOAD)
#undef LOAD
    return SLUICE_SUCCESS;
}

void slc_vk_name(const struct slc_vk *vk, VkObjectType type, uint64_t handle, const char *name)
{
    if (!vk->SetDebugUtilsObjectNameEXT || !handle)
        return;
    char text[128];
    snprintf(text, sizeof text, "sluice: %s", name);
    const VkDebugUtilsObjectNameInfoEXT info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
        .objectType = type,
        .objectHandle = handle,
        .pObjectName = text};
    vk->SetDebugUtilsObjectNameEXT(vk->device, &info); /* only a name: failure does no harm */
}

SluiceResult slc_vk_result(const struct slc_vk *vk, VkResult result, const char *what)
{
    if (result >= 0)
        return SLUICE_SUCCESS;
    slc_log(&vk->log, SLUICE_LOG_ERROR, "%s failed with VkResult %d", what, (int)result);
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY: return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    case VK_ERROR_DEVICE_LOST: return SLUICE_ERROR_DEVICE_LOST;
    default: return SLUICE_ERROR_VULKAN;
    }
}
