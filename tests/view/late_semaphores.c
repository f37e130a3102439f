/* RTLD_NEXT */
#define _GNU_SOURCE
/* For LD_PRELOAD: a Vulkan device whose timeline semaphores show a value only to those who wait for
 * it. A driver may signal the fence of a submission before its semaphores. */
#include <vulkan/vulkan.h>

#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

#define MOST 64

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static VkSemaphore semaphores[MOST];
static uint64_t values[MOST];

#define REAL(name) ((PFN_##name)find_real(#name))

/* Copies through memory, since ISO C cannot convert dlsym's pointer to a function pointer. */
static PFN_vkVoidFunction find_real(const char *name)
{
    void *found = dlsym(RTLD_NEXT, name);
    PFN_vkVoidFunction function;
    memcpy(&function, &found, sizeof function);
    return function;
}

/* Returns the largest value that was waited for, with `value`. */
static uint64_t note(VkSemaphore semaphore, uint64_t value)
{
    pthread_mutex_lock(&lock);
    for (int i = 0; i < MOST; i++)
        if (semaphores[i] == semaphore || !semaphores[i]) {
            semaphores[i] = semaphore;
            value = values[i] = value > values[i] ? value : values[i];
            break;
        }
    pthread_mutex_unlock(&lock);
    return value;
}

VkResult vkWaitSemaphores(VkDevice device, const VkSemaphoreWaitInfo *info, uint64_t timeout)
{
    const VkResult result = REAL(vkWaitSemaphores)(device, info, timeout);
    for (uint32_t i = 0; result == VK_SUCCESS && i < info->semaphoreCount; i++)
        note(info->pSemaphores[i], info->pValues[i]);
    return result;
}

VkResult vkGetSemaphoreCounterValue(VkDevice device, VkSemaphore semaphore, uint64_t *value)
{
    const VkResult result = REAL(vkGetSemaphoreCounterValue)(device, semaphore, value);
    const uint64_t waited = note(semaphore, 0);
    *value = waited < *value ? waited : *value;
    return result;
}

PFN_vkVoidFunction vkGetDeviceProcAddr(VkDevice device, const char *name)
{
    if (strcmp(name, "vkWaitSemaphores") == 0)
        return (PFN_vkVoidFunction)vkWaitSemaphores;
    if (strcmp(name, "vkGetSemaphoreCounterValue") == 0)
        return (PFN_vkVoidFunction)vkGetSemaphoreCounterValue;
    return REAL(vkGetDeviceProcAddr)(device, name);
}

PFN_vkVoidFunction vkGetInstanceProcAddr(VkInstance instance, const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)vkGetDeviceProcAddr;
    return REAL(vkGetInstanceProcAddr)(instance, name);
}
