#include "vulkan/dispatch.h"

#include "base/log.h"

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
        slc_log(&vk->log, SLUICE_LOG_ERROR, "the Vulkan instance has no vk" #name);                \
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
        slc_log(&vk->log, SLUICE_LOG_ERROR, "the Vulkan device has no vk" #name);                  \
        return SLUICE_ERROR_UNSUPPORTED;                                                           \
    }
    SLC_VK_DEVICE_FUNCTIONS(LOAD)
#undef LOAD
    return SLUICE_SUCCESS;
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
