#include "extremes/failing_layer.h"

#include <string.h>

struct failing_layer failing_layer;

static bool fails(void)
{
    struct failing_layer *l = &failing_layer;
    uint64_t call = ++l->calls;
    return l->failing_call && (call == l->failing_call || (l->fails_on && call > l->failing_call));
}

/* A function that creates something or fails. */
#define MAKER(name, parameters, arguments)                                                         \
    static PFN_vk##name next_##name;                                                               \
    static VKAPI_ATTR VkResult VKAPI_CALL layer_##name parameters                                  \
    {                                                                                              \
        return fails() ? failing_layer.failure : next_##name arguments;                            \
    }

#define CREATE(what)                                                                               \
    MAKER(Create##what,                                                                            \
          (VkDevice device, const Vk##what##CreateInfo *info, const VkAllocationCallbacks *cb,     \
           Vk##what *made),                                                                        \
          (device, info, cb, made))

CREATE(Buffer)
CREATE(DescriptorPool)
CREATE(DescriptorSetLayout)
CREATE(Image)
CREATE(ImageView)
CREATE(PipelineCache)
CREATE(PipelineLayout)
CREATE(Sampler)
CREATE(Semaphore)
CREATE(ShaderModule)
MAKER(CreateComputePipelines,
      (VkDevice device, VkPipelineCache cache, uint32_t count,
       const VkComputePipelineCreateInfo *infos, const VkAllocationCallbacks *cb, VkPipeline *made),
      (device, cache, count, infos, cb, made))
MAKER(AllocateDescriptorSets,
      (VkDevice device, const VkDescriptorSetAllocateInfo *info, VkDescriptorSet *made),
      (device, info, made))
MAKER(BindBufferMemory,
      (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),
      (device, buffer, memory, offset))
MAKER(BindImageMemory, (VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset),
      (device, image, memory, offset))
MAKER(MapMemory,
      (VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
       VkMemoryMapFlags flags, void **mapped),
      (device, memory, offset, size, flags, mapped))
MAKER(GetSemaphoreCounterValue, (VkDevice device, VkSemaphore semaphore, uint64_t *value),
      (device, semaphore, value))
MAKER(QueueBindSparse,
      (VkQueue queue, uint32_t count, const VkBindSparseInfo *infos, VkFence fence),
      (queue, count, infos, fence))

/* Freed memory is not counted. The test sets when there is memory again. */
static PFN_vkAllocateMemory next_AllocateMemory;
static VKAPI_ATTR VkResult VKAPI_CALL layer_AllocateMemory(VkDevice device,
                                                           const VkMemoryAllocateInfo *info,
                                                           const VkAllocationCallbacks *cb,
                                                           VkDeviceMemory *memory)
{
    uint64_t size = info->allocationSize >= 1u << 18 ? info->allocationSize : 0;
    if (fails())
        return failing_layer.failure;
    if (size > failing_layer.memory_left)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    failing_layer.memory_left -= size;
    return next_AllocateMemory(device, info, cb, memory);
}

/* The underlying device is not lost, and must finish its work before anything is destroyed. */
static PFN_vkDeviceWaitIdle next_DeviceWaitIdle;
static VKAPI_ATTR VkResult VKAPI_CALL layer_DeviceWaitIdle(VkDevice device)
{
    VkResult result = next_DeviceWaitIdle(device);
    return fails() ? failing_layer.failure : result;
}

/* A lost device returns from waits at once, even for work that was never submitted. */
static PFN_vkWaitSemaphores next_WaitSemaphores;
static VKAPI_ATTR VkResult VKAPI_CALL layer_WaitSemaphores(VkDevice device,
                                                           const VkSemaphoreWaitInfo *info,
                                                           uint64_t timeout)
{
    if (!fails())
        return next_WaitSemaphores(device, info, timeout);
    next_DeviceWaitIdle(device);
    failing_layer.waited_in_vain++;
    return failing_layer.failure;
}

/* clang-format off */
#define FUNCTIONS(X)                                                                               \
    X(AllocateDescriptorSets) X(AllocateMemory) X(BindBufferMemory) X(BindImageMemory)             \
    X(CreateBuffer) X(CreateComputePipelines) X(CreateDescriptorPool)                              \
    X(CreateDescriptorSetLayout) X(CreateImage) X(CreateImageView) X(CreatePipelineCache) X(CreatePipelineLayout)         \
    X(CreateSampler) X(CreateSemaphore) X(CreateShaderModule) X(DeviceWaitIdle)                    \
    X(GetSemaphoreCounterValue) X(MapMemory) X(QueueBindSparse) X(WaitSemaphores)
/* clang-format on */

static PFN_vkGetDeviceProcAddr next_GetDeviceProcAddr;

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_of_device(VkDevice device, const char *name)
{
    PFN_vkVoidFunction function = next_GetDeviceProcAddr(device, name);
#define INTERCEPT(function_name)                                                                   \
    if (function && strcmp(name, "vk" #function_name) == 0) {                                      \
        next_##function_name = (PFN_vk##function_name)function;                                    \
        return (PFN_vkVoidFunction)layer_##function_name;                                          \
    }
    FUNCTIONS(INTERCEPT)
#undef INTERCEPT
    return function;
}

PFN_vkVoidFunction failing_layer_get(VkInstance instance, const char *name)
{
    PFN_vkVoidFunction function = failing_layer.get(instance, name);
    if (strcmp(name, "vkGetDeviceProcAddr") != 0)
        return function;
    next_GetDeviceProcAddr = (PFN_vkGetDeviceProcAddr)function;
    return (PFN_vkVoidFunction)get_of_device;
}

void failing_layer_set(struct harness *h, uint64_t call, bool fails_on, VkResult failure)
{
    failing_layer = (struct failing_layer){.get = h->get,
                                           .failing_call = call,
                                           .fails_on = fails_on,
                                           .failure = failure,
                                           .memory_left = UINT64_MAX};
}
