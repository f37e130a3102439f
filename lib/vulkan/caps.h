/** Capabilities of a device. */
#ifndef SLC_VULKAN_CAPS_H
#define SLC_VULKAN_CAPS_H

#include "vulkan/dispatch.h"

struct slc_caps {
    SluiceVulkanDeviceCapabilities public;
    VkPhysicalDeviceMemoryProperties memory;
    uint64_t max_allocation_size;      ///< bytes of one block of memory; 0: unknown
    uint32_t max_storage_buffer_range; ///< bytes
    uint32_t max_image_array_layers;
    uint32_t max_stage_samplers, max_stage_images; ///< per shader stage; samplers: also combined
    uint32_t max_stage_storage_buffers;            ///< per shader stage and descriptor set
    bool buffer_device_address;                    ///< the device has the feature
    bool image_cube_array;
    bool array_dynamic_indexing; ///< shaderSampledImageArrayDynamicIndexing
    bool timeline_semaphore;
};

/** Needs only the instance functions. */
void slc_caps_init(struct slc_caps *caps, const struct slc_vk *vk);

/**
 * Returns the first type of `type_bits` with all flags of `required` and `preferred`, else the
 * first one with all flags of `required`. UINT32_MAX if there is none.
 */
uint32_t slc_find_memory_type(const VkPhysicalDeviceMemoryProperties *memory, uint32_t type_bits,
                              VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred);

/** Returns the index of the largest device-local memory heap. */
uint32_t slc_device_memory_heap(const struct slc_caps *caps);
/** Returns the bytes of the largest device-local heap. Larger allocations are not allowed. */
uint64_t slc_device_memory_size(const struct slc_caps *caps);

#define SLC_DEFAULT_TEXTURE_COUNT 1024u

static inline bool slc_mode_is_known(SluiceResidencyMode mode)
{
    return mode == SLUICE_RESIDENCY_MODE_AUTO || mode == SLUICE_RESIDENCY_MODE_SPARSE ||
           mode == SLUICE_RESIDENCY_MODE_PAGED || mode == SLUICE_RESIDENCY_MODE_DENSE;
}

/** Resolves a mode like sluiceChooseVulkanResidencyMode. But AUTO becomes SPARSE, not PAGED, on a
 * sparse device that cannot index arrays of images dynamically. */
SluiceResidencyMode slc_choose_mode(const struct slc_caps *caps, SluiceResidencyMode mode,
                                    uint32_t max_texture_count);

/** Returns the feature that a mode other than AUTO requires and the device lacks; NULL: none. */
const char *slc_missing_for_mode(const struct slc_caps *caps, SluiceResidencyMode mode);

#endif /* SLC_VULKAN_CAPS_H */
