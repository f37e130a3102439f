/** What a device can do. */
#ifndef SLC_VULKAN_CAPS_H
#define SLC_VULKAN_CAPS_H

#include "vulkan/dispatch.h"

struct slc_caps {
    SluiceVulkanDeviceCapabilities public;
    VkPhysicalDeviceMemoryProperties memory;
    uint32_t max_storage_buffer_range; ///< bytes
    bool timeline_semaphore;
};

/** Needs only the instance functions. */
void slc_caps_init(struct slc_caps *caps, const struct slc_vk *vk);

/**
 * The first type of `type_bits` with all of `required` and `preferred`, else with `required` and
 * most of `preferred` left out; UINT32_MAX if there is none.
 */
uint32_t slc_find_memory_type(const VkPhysicalDeviceMemoryProperties *memory, uint32_t type_bits,
                              VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred);

#endif /* SLC_VULKAN_CAPS_H */
