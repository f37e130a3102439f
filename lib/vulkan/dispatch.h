/** The device's functions, loaded through the application's vkGetInstanceProcAddr; no globals. */
#ifndef SLC_VULKAN_DISPATCH_H
#define SLC_VULKAN_DISPATCH_H

#include <sluice/vulkan.h>

/* clang-format off */
#define SLC_VK_INSTANCE_FUNCTIONS(X)                                                               \
    X(GetDeviceProcAddr) X(GetPhysicalDeviceFeatures2) X(GetPhysicalDeviceFormatProperties) \
    X(GetPhysicalDeviceImageFormatProperties)   \
    X(GetPhysicalDeviceMemoryProperties) X(GetPhysicalDeviceProperties2)                           \
    X(GetPhysicalDeviceQueueFamilyProperties) X(GetPhysicalDeviceSparseImageFormatProperties)

#define SLC_VK_DEVICE_FUNCTIONS(X)                                                                 \
    X(AllocateCommandBuffers) X(AllocateDescriptorSets) X(AllocateMemory) X(BeginCommandBuffer) X(BindBufferMemory) X(BindImageMemory)             \
    X(CmdBindDescriptorSets)                                                                       \
    X(CmdBindPipeline) X(CmdCopyBuffer) X(CmdCopyBufferToImage) X(CmdCopyImage) X(CmdDispatch)                     \
    X(CmdFillBuffer)                                                        \
    X(CmdPipelineBarrier) X(CmdPushConstants) X(CmdUpdateBuffer) X(CreateBuffer)                   \
    X(CreateCommandPool) X(CreateComputePipelines) X(CreateDescriptorPool) X(CreateDescriptorSetLayout) X(CreateImage)  \
    X(CreateImageView) X(CreatePipelineCache) X(CreatePipelineLayout) X(CreateSampler) X(CreateSemaphore)                 \
    X(CreateShaderModule)                                                                         \
    X(DestroyBuffer) X(DestroyCommandPool) X(EndCommandBuffer) X(DestroyDescriptorPool) X(DestroyDescriptorSetLayout) X(DestroyImage)        \
    X(DestroyImageView) X(DestroyPipeline) X(DestroyPipelineCache) X(DestroyPipelineLayout) X(DestroySampler) X(DestroySemaphore)             \
    X(DestroyShaderModule) X(DeviceWaitIdle) X(FreeMemory) X(GetBufferMemoryRequirements)          \
    X(GetImageMemoryRequirements) X(GetImageSparseMemoryRequirements) X(GetSemaphoreCounterValue)  \
    X(MapMemory) X(QueueBindSparse) X(QueueSubmit) X(UpdateDescriptorSets)        \
    X(WaitSemaphores)
/* clang-format on */

#define SLC_MAX_QUEUE_FAMILIES 8u

struct slc_memory_client; ///< memory_budget.h

struct slc_vk {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
#define SLC_VK_MEMBER(name) PFN_vk##name name;
    SLC_VK_INSTANCE_FUNCTIONS(SLC_VK_MEMBER)
    SLC_VK_DEVICE_FUNCTIONS(SLC_VK_MEMBER)
#undef SLC_VK_MEMBER
    PFN_vkSetDebugUtilsObjectNameEXT SetDebugUtilsObjectNameEXT; ///< NULL: objects get no names
    PFN_vkGetBufferDeviceAddress GetBufferDeviceAddress; ///< NULL: buffers have no addresses
    VkPipelineCache pipeline_cache;                      ///< may be VK_NULL_HANDLE
    SluiceLogCallback log;
    struct slc_memory_client *memory_client;             ///< NULL: memory is not counted
    const SluiceDeviceMemoryCallbacks *memory_callbacks; ///< NULL: Vulkan allocates
    const SluiceVulkanQueueLockCallbacks *queue_lock;    ///< NULL: none; queues.h uses it
    /** Distinct families of all queues that use images and buffers. One: exclusive sharing. */
    uint32_t families[SLC_MAX_QUEUE_FAMILIES];
    uint32_t family_count;
};

/** Loads the instance functions. Errors: UNSUPPORTED if a function is missing. */
SluiceResult slc_vk_init_instance(struct slc_vk *vk, VkInstance instance,
                                  VkPhysicalDevice physical_device, PFN_vkGetInstanceProcAddr get,
                                  const SluiceLogCallback *log);

/** Loads the device functions, after slc_vk_init_instance. */
SluiceResult slc_vk_init_device(struct slc_vk *vk, VkDevice device);

/** Names an object for debuggers, if the instance has VK_EXT_debug_utils: "sluice: " and `name`.
 *  VK_NULL_HANDLE is allowed. */
void slc_vk_name(const struct slc_vk *vk, VkObjectType type, uint64_t handle, const char *name);

/** Fills in how the queues of all families share a VkImageCreateInfo or VkBufferCreateInfo. */
#define SLC_VK_SHARE(vk, create)                                                                   \
    do {                                                                                           \
        if ((vk)->family_count > 1) {                                                              \
            (create)->sharingMode = VK_SHARING_MODE_CONCURRENT;                                    \
            (create)->queueFamilyIndexCount = (vk)->family_count;                                  \
            (create)->pQueueFamilyIndices = (vk)->families;                                        \
        }                                                                                          \
    } while (0)

/** Converts a VkResult; logs `what` and the code unless it is success. */
SluiceResult slc_vk_result(const struct slc_vk *vk, VkResult result, const char *what);

#endif /* SLC_VULKAN_DISPATCH_H */
