/* RTLD_NEXT */
#define _GNU_SOURCE
/* Library for LD_PRELOAD: the Vulkan device is lost at submission LOSE_AFTER. */
#include <vulkan/vulkan.h>

#include <dlfcn.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static atomic_bool lost;
static atomic_int submissions;

#define REAL(name) ((PFN_##name)find_real(#name))

/* Copies through memory, because ISO C cannot convert dlsym's pointer to one of a function. */
static PFN_vkVoidFunction find_real(const char *name)
{
    void *found = dlsym(RTLD_NEXT, name);
    PFN_vkVoidFunction function;
    memcpy(&function, &found, sizeof function);
    return function;
}

/* Waits for what runs first: a driver that is not really lost must not see its objects go. */
static VkBool32 is_lost(VkQueue queue)
{
    const char *text = getenv("LOSE_AFTER");
    if (!atomic_load(&lost) && text && atomic_fetch_add(&submissions, 1) >= atoi(text)) {
        REAL(vkQueueWaitIdle)(queue);
        atomic_store(&lost, VK_TRUE);
    }
    return atomic_load(&lost);
}

VkResult vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo *infos, VkFence fence)
{
    return is_lost(queue) ? VK_ERROR_DEVICE_LOST : REAL(vkQueueSubmit)(queue, count, infos, fence);
}

VkResult vkQueueBindSparse(VkQueue queue, uint32_t count, const VkBindSparseInfo *infos,
                           VkFence fence)
{
    return is_lost(queue) ? VK_ERROR_DEVICE_LOST
                          : REAL(vkQueueBindSparse)(queue, count, infos, fence);
}

VkResult vkQueueWaitIdle(VkQueue queue)
{
    return atomic_load(&lost) ? VK_ERROR_DEVICE_LOST : REAL(vkQueueWaitIdle)(queue);
}

VkResult vkDeviceWaitIdle(VkDevice device)
{
    return atomic_load(&lost) ? VK_ERROR_DEVICE_LOST : REAL(vkDeviceWaitIdle)(device);
}

VkResult vkWaitForFences(VkDevice device, uint32_t count, const VkFence *fences, VkBool32 all,
                         uint64_t timeout)
{
    return atomic_load(&lost) ? VK_ERROR_DEVICE_LOST
                              : REAL(vkWaitForFences)(device, count, fences, all, timeout);
}

VkResult vkWaitSemaphores(VkDevice device, const VkSemaphoreWaitInfo *info, uint64_t timeout)
{
    return atomic_load(&lost) ? VK_ERROR_DEVICE_LOST
                              : REAL(vkWaitSemaphores)(device, info, timeout);
}

VkResult vkGetSemaphoreCounterValue(VkDevice device, VkSemaphore semaphore, uint64_t *value)
{
    return atomic_load(&lost) ? VK_ERROR_DEVICE_LOST
                              : REAL(vkGetSemaphoreCounterValue)(device, semaphore, value);
}

VkResult vkQueuePresentKHR(VkQueue queue, const VkPresentInfoKHR *info)
{
    return atomic_load(&lost) ? VK_ERROR_DEVICE_LOST : REAL(vkQueuePresentKHR)(queue, info);
}

VkResult vkAcquireNextImageKHR(VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout,
                               VkSemaphore semaphore, VkFence fence, uint32_t *image)
{
    return atomic_load(&lost)
               ? VK_ERROR_DEVICE_LOST
               : REAL(vkAcquireNextImageKHR)(device, swapchain, timeout, semaphore, fence, image);
}

PFN_vkVoidFunction vkGetDeviceProcAddr(VkDevice device, const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } own[] = {{"vkQueueSubmit", (PFN_vkVoidFunction)vkQueueSubmit},
               {"vkQueueBindSparse", (PFN_vkVoidFunction)vkQueueBindSparse},
               {"vkDeviceWaitIdle", (PFN_vkVoidFunction)vkDeviceWaitIdle},
               {"vkWaitSemaphores", (PFN_vkVoidFunction)vkWaitSemaphores},
               {"vkGetSemaphoreCounterValue", (PFN_vkVoidFunction)vkGetSemaphoreCounterValue}};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (strcmp(own[i].name, name) == 0)
            return own[i].function;
    return REAL(vkGetDeviceProcAddr)(device, name);
}

PFN_vkVoidFunction vkGetInstanceProcAddr(VkInstance instance, const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)vkGetDeviceProcAddr;
    return REAL(vkGetInstanceProcAddr)(instance, name);
}
