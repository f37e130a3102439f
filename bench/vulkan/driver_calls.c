#include "driver_calls.h"

#include "../manager/figures.h"

#include <stdio.h>
#include <string.h>

/* Whatever can be called in a frame: result, name, parameters, arguments. */
#define CALLS(VOID, RESULT)                                                                        \
    VOID(CmdBindDescriptorSets,                                                                    \
         (VkCommandBuffer a, VkPipelineBindPoint b, VkPipelineLayout c, uint32_t d, uint32_t e,    \
          const VkDescriptorSet *f, uint32_t g, const uint32_t *h),                                \
         (a, b, c, d, e, f, g, h))                                                                 \
    VOID(CmdBindPipeline, (VkCommandBuffer a, VkPipelineBindPoint b, VkPipeline c), (a, b, c))     \
    VOID(CmdCopyBuffer,                                                                            \
         (VkCommandBuffer a, VkBuffer b, VkBuffer c, uint32_t d, const VkBufferCopy *e),           \
         (a, b, c, d, e))                                                                          \
    VOID(CmdCopyImage,                                                                             \
         (VkCommandBuffer a, VkImage b, VkImageLayout c, VkImage d, VkImageLayout e, uint32_t f,   \
          const VkImageCopy *g),                                                                   \
         (a, b, c, d, e, f, g))                                                                    \
    VOID(CmdCopyBufferToImage,                                                                     \
         (VkCommandBuffer a, VkBuffer b, VkImage c, VkImageLayout d, uint32_t e,                   \
          const VkBufferImageCopy *f),                                                             \
         (a, b, c, d, e, f))                                                                       \
    VOID(CmdDispatch, (VkCommandBuffer a, uint32_t b, uint32_t c, uint32_t d), (a, b, c, d))       \
    VOID(CmdDispatchIndirect, (VkCommandBuffer a, VkBuffer b, VkDeviceSize c), (a, b, c))          \
    VOID(CmdFillBuffer,                                                                            \
         (VkCommandBuffer a, VkBuffer b, VkDeviceSize c, VkDeviceSize d, uint32_t e),              \
         (a, b, c, d, e))                                                                          \
    VOID(CmdPipelineBarrier,                                                                       \
         (VkCommandBuffer a, VkPipelineStageFlags b, VkPipelineStageFlags c, VkDependencyFlags d,  \
          uint32_t e, const VkMemoryBarrier *f, uint32_t g, const VkBufferMemoryBarrier *h,        \
          uint32_t i, const VkImageMemoryBarrier *j),                                              \
         (a, b, c, d, e, f, g, h, i, j))                                                           \
    VOID(CmdPushConstants,                                                                         \
         (VkCommandBuffer a, VkPipelineLayout b, VkShaderStageFlags c, uint32_t d, uint32_t e,     \
          const void *f),                                                                          \
         (a, b, c, d, e, f))                                                                       \
    VOID(CmdUpdateBuffer,                                                                          \
         (VkCommandBuffer a, VkBuffer b, VkDeviceSize c, VkDeviceSize d, const void *e),           \
         (a, b, c, d, e))                                                                          \
    VOID(UpdateDescriptorSets,                                                                     \
         (VkDevice a, uint32_t b, const VkWriteDescriptorSet *c, uint32_t d,                       \
          const VkCopyDescriptorSet *e),                                                           \
         (a, b, c, d, e))                                                                          \
    VOID(FreeMemory, (VkDevice a, VkDeviceMemory b, const VkAllocationCallbacks *c), (a, b, c))    \
    VOID(DestroyImage, (VkDevice a, VkImage b, const VkAllocationCallbacks *c), (a, b, c))         \
    VOID(DestroyImageView, (VkDevice a, VkImageView b, const VkAllocationCallbacks *c), (a, b, c)) \
    VOID(GetImageMemoryRequirements, (VkDevice a, VkImage b, VkMemoryRequirements * c), (a, b, c)) \
    RESULT(AllocateMemory,                                                                         \
           (VkDevice a, const VkMemoryAllocateInfo *b, const VkAllocationCallbacks *c,             \
            VkDeviceMemory *d),                                                                    \
           (a, b, c, d))                                                                           \
    RESULT(BeginCommandBuffer, (VkCommandBuffer a, const VkCommandBufferBeginInfo *b), (a, b))     \
    RESULT(BindImageMemory, (VkDevice a, VkImage b, VkDeviceMemory c, VkDeviceSize d),             \
           (a, b, c, d))                                                                           \
    RESULT(CreateImage,                                                                            \
           (VkDevice a, const VkImageCreateInfo *b, const VkAllocationCallbacks *c, VkImage *d),   \
           (a, b, c, d))                                                                           \
    RESULT(CreateImageView,                                                                        \
           (VkDevice a, const VkImageViewCreateInfo *b, const VkAllocationCallbacks *c,            \
            VkImageView *d),                                                                       \
           (a, b, c, d))                                                                           \
    RESULT(EndCommandBuffer, (VkCommandBuffer a), (a))                                             \
    RESULT(GetSemaphoreCounterValue, (VkDevice a, VkSemaphore b, uint64_t * c), (a, b, c))         \
    RESULT(QueueBindSparse, (VkQueue a, uint32_t b, const VkBindSparseInfo *c, VkFence d),         \
           (a, b, c, d))                                                                           \
    RESULT(QueueSubmit, (VkQueue a, uint32_t b, const VkSubmitInfo *c, VkFence d), (a, b, c, d))   \
    RESULT(WaitSemaphores, (VkDevice a, const VkSemaphoreWaitInfo *b, uint64_t c), (a, b, c))

static struct {
    struct driver_calls calls;
    PFN_vkGetDeviceProcAddr GetDeviceProcAddr;
#define MEMBER(name, parameters, arguments) PFN_vk##name name;
    CALLS(MEMBER, MEMBER)
#undef MEMBER
} driver;

static void leave(uint64_t start)
{
    driver.calls.ns += now_ns() - start;
    driver.calls.count++;
}

#define TIMED_VOID(name, parameters, arguments)                                                    \
    static VKAPI_ATTR void VKAPI_CALL timed_##name parameters                                      \
    {                                                                                              \
        uint64_t start = now_ns();                                                                 \
        driver.name arguments;                                                                     \
        leave(start);                                                                              \
    }
#define TIMED_RESULT(name, parameters, arguments)                                                  \
    static VKAPI_ATTR VkResult VKAPI_CALL timed_##name parameters                                  \
    {                                                                                              \
        uint64_t start = now_ns();                                                                 \
        VkResult result = driver.name arguments;                                                   \
        leave(start);                                                                              \
        return result;                                                                             \
    }
CALLS(TIMED_VOID, TIMED_RESULT)

/* Returns whether a function is called only at creation and destruction. */
static bool is_untimed(const char *name)
{
    static const char *const prefixes[] = {"vkCreate",     "vkDestroy", "vkAllocate", "vkFree",
                                           "vkMap",        "vkBind",    "vkGet",      "vkReset",
                                           "vkDeviceWait", "vkUnmap",   "vkFlush"};
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++)
        if (strncmp(name, prefixes[i], strlen(prefixes[i])) == 0)
            return true;
    return false;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device(VkDevice device, const char *name)
{
    PFN_vkVoidFunction function = driver.GetDeviceProcAddr(device, name);
#define WRAP(which, parameters, arguments)                                                         \
    if (strcmp(name, "vk" #which) == 0) {                                                          \
        driver.which = (PFN_vk##which)function;                                                    \
        return function ? (PFN_vkVoidFunction)timed_##which : NULL;                                \
    }
    CALLS(WRAP, WRAP)
#undef WRAP
    if (is_untimed(name))
        return function;
    fprintf(stderr, "%s is called, but bench/vulkan/driver_calls.c does not time it\n", name);
    return NULL;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL driver_calls_get(VkInstance instance, const char *name)
{
    PFN_vkVoidFunction function = vkGetInstanceProcAddr(instance, name);
    if (strcmp(name, "vkGetDeviceProcAddr") != 0)
        return function;
    driver.GetDeviceProcAddr = (PFN_vkGetDeviceProcAddr)function;
    return (PFN_vkVoidFunction)get_device;
}

struct driver_calls driver_calls_take(void)
{
    struct driver_calls calls = driver.calls;
    driver.calls = (struct driver_calls){0};
    return calls;
}

static VKAPI_ATTR void VKAPI_CALL no_dispatch(VkCommandBuffer a, uint32_t b, uint32_t c, uint32_t d)
{
    touched(a);
    (void)b, (void)c, (void)d;
}

double driver_calls_overhead(void)
{
    const uint32_t count = 100000;
    PFN_vkCmdDispatch dispatch = driver.CmdDispatch;
    struct driver_calls calls = driver.calls;
    driver.CmdDispatch = no_dispatch;
    uint64_t start = now_ns();
    for (uint32_t i = 0; i < count; i++)
        timed_CmdDispatch(VK_NULL_HANDLE, 1, 1, 1);
    double whole = (double)(now_ns() - start);
    double inside = (double)(driver.calls.ns - calls.ns);
    driver.CmdDispatch = dispatch;
    driver.calls = calls;
    return (whole - inside) / count;
}
