/** What the streamers and demand loaders of a device share. */
#ifndef SLC_VULKAN_CONTEXT_H
#define SLC_VULKAN_CONTEXT_H

#include "vulkan/caps.h"
#include "vulkan/device_budget.h"
#include "vulkan/memory_budget.h"
#include "vulkan/shared_parts.h"

#include <sluice/vulkan_context.h>

#include <stdatomic.h>

struct SluiceVulkanContext {
    SluiceAllocationCallbacks cb;
    VkQueue sparse_queue; ///< VK_NULL_HANDLE: none
    VkQueue upload_queue; ///< VK_NULL_HANDLE: none
    uint32_t upload_family;
    VkExtent3D upload_granularity; ///< of its family
    struct slc_vk vk;
    VkPipelineCache pipeline_cache; ///< owned; VK_NULL_HANDLE: vk has the application's
    struct slc_caps caps;
    struct slc_shared_parts shared;
    SluiceDeviceMemoryCallbacks memory_callbacks; ///< of vk, if the application has any
    SluiceVulkanQueueLockCallbacks queue_lock;    ///< of vk, if the application has any
    uint32_t max_binds_per_call;
    struct slc_memory_budget budget;
    struct slc_device_budget device_budget;
    struct slc_memory_client memory; ///< of vk: what all front ends share
    atomic_uint child_count;         ///< streamers and demand loaders
};

/** A streamer or demand loader counts as a child from the start of its creation to its end. */
void slc_context_add_child(SluiceVulkanContext *context);
void slc_context_remove_child(SluiceVulkanContext *context);

#endif /* SLC_VULKAN_CONTEXT_H */
