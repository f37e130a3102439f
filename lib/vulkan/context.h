/** Context: parts that the streamers and demand loaders of a device share. */
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
    VkExtent3D upload_granularity; ///< minImageTransferGranularity of upload_family
    struct slc_vk vk;
    VkPipelineCache pipeline_cache; ///< owned; VK_NULL_HANDLE: vk has the application's
    struct slc_caps caps;
    struct slc_shared_parts shared;
    SluiceDeviceMemoryCallbacks memory_callbacks; ///< for `vk`, if the application has set them
    SluiceVulkanQueueLockCallbacks queue_lock;    ///< for `vk`, if the application has set them
    uint32_t max_binds_per_call;
    struct slc_memory_budget budget;
    struct slc_device_budget device_budget;
    struct slc_memory_client memory; ///< client of `vk`: counts memory that front ends share
    atomic_uint child_count;         ///< streamers and demand loaders
};

/** Counts a streamer or demand loader, from the start of its creation to its destruction. */
void slc_context_add_child(SluiceVulkanContext *context);
void slc_context_remove_child(SluiceVulkanContext *context);

#endif /* SLC_VULKAN_CONTEXT_H */
