/** Allocation of device memory. All blocks are allocated, freed and counted here, by the
 *  application's callbacks if there are any. */
#ifndef SLC_VULKAN_MEMORY_H
#define SLC_VULKAN_MEMORY_H

#include "vulkan/dispatch.h"

struct slc_memory_request {
    uint64_t size, alignment; ///< bytes; the alignment is a power of two
    uint32_t type;            ///< memory type index
    SluiceDeviceMemoryPurpose purpose;
    bool mapped, images;
    bool device_address; ///< for a buffer with VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT
    const char *name;    ///< name for debuggers
};

/** Part of a VkDeviceMemory, or all of it. Zeroed: none. */
struct slc_memory {
    VkDeviceMemory memory;
    uint64_t offset, size; ///< bytes
    void *mapped;          ///< the first byte at `offset`; NULL: not mapped
    void *allocation;      ///< handle of the memory callbacks
    SluiceDeviceMemoryPurpose purpose;
    bool is_beyond_budget; ///< after a failure: the budget refused it, not the driver
};

/**
 * Allocates a block. After a failure `*memory` is zeroed, except `is_beyond_budget`, and nothing is
 * counted. VK_ERROR_OUT_OF_DEVICE_MEMORY, not logged, for tile memory beyond the budget.
 * VK_ERROR_UNKNOWN, logged, if the callbacks returned other memory than requested.
 */
VkResult slc_memory_allocate(const struct slc_vk *vk, const struct slc_memory_request *request,
                             struct slc_memory *memory);
/** Frees a block, and zeroes it. It may be zeroed already. */
void slc_memory_free(const struct slc_vk *vk, struct slc_memory *memory);

/** Moves a block from the count of `from` to the count of `to`. */
void slc_memory_move(const struct slc_vk *from, const struct slc_vk *to,
                     const struct slc_memory *memory);

#endif /* SLC_VULKAN_MEMORY_H */
