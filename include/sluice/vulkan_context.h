/**
 * Context: what streamers (vulkan.h) and demand loaders (demand.h) of one Vulkan device share. Part
 * of `sluice-vulkan`.
 *
 * Create one context per VkDevice, then create streamers and demand loaders from it. The
 * application keeps ownership of instance, device and queues. Destroy streamers and demand loaders
 * first, then the context, then the device.
 */
#ifndef SLUICE_VULKAN_CONTEXT_H
#define SLUICE_VULKAN_CONTEXT_H

#include <sluice/base.h>

#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceVulkanContext SluiceVulkanContext;

/** Settings of a context. A field of zero selects its default. */
typedef struct SluiceVulkanContextCreateInfo {
    uint32_t structSize;             ///< sizeof(SluiceVulkanContextCreateInfo).
    uint32_t queueFamilyIndex;       ///< Family of the queue for frames and launches. Must support
                                     ///< compute.
    VkInstance instance;             ///< Required. Vulkan 1.2.
    VkPhysicalDevice physicalDevice; ///< Required.
    VkDevice device; ///< Required. Vulkan 1.2, with the features of sluiceRequireVulkanFeatures.
    PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr; ///< Required.
    /** Queue of a family with SPARSE_BINDING; may be the drawing queue. Required for streamers in
     *  sparse mode. */
    VkQueue sparseQueue;
    uint32_t sparseQueueFamilyIndex; ///< Family of sparseQueue. Ignored if sparseQueue is NULL.
    const SluiceAllocationCallbacks *pAllocator; ///< Copied. Default: malloc and free.
    /** Receives the messages of the context and of everything created from it. */
    SluiceLogCallback log;
} SluiceVulkanContextCreateInfo;

/**
 * Creates a context.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a queue family that does not
 * exist or lacks a capability; SLUICE_ERROR_UNSUPPORTED if instance or device were created for less
 * than Vulkan 1.2; SLUICE_ERROR_OUT_OF_HOST_MEMORY. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateVulkanContext(const SluiceVulkanContextCreateInfo *pCreateInfo,
                                                  SluiceVulkanContext **pContext);

/**
 * Destroys a context. NULL is allowed.
 *
 * Destroy its streamers and demand loaders first. While one of them exists, this function logs an
 * error and does nothing; the context stays valid, and can be destroyed later.
 *
 * Thread safety: external on `context`.
 */
SLUICE_API void sluiceDestroyVulkanContext(SluiceVulkanContext *context);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_CONTEXT_H */
