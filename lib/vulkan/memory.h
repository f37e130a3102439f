/** Blocks of device memory: all of it is allocated and freed here, by the application's callbacks
 *  if there are any, and counted. */
#ifndef SLC_VULKAN_MEMORY_H
#define SLC_VULKAN_MEMORY_H

#include "vulkan/dispatch.h"

struct slc_memory_request {
    uint64_t size, alignment; ///< bytes; the alignment is a power of two
    uint32_t type;            ///< memory type index
    SluiceDeviceMemoryPurpose purpose;
    bool mapped, images;
    bool device_address; ///< of a buffer with VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT
    const char *name;    ///< for debuggers
};

/** Part of a VkDeviceMemory, or all of it. Zeroed: none. */
struct slc_memory {
    VkDeviceMemory memory;
    uint64_t offset, size; ///< bytes
    void *mapped;          ///< the first byte at `offset`; NULL: not mapped
    void *allocation;      ///< what the callbacks call it
    SluiceDeviceMemoryPurpose purpose;
    bool is_beyond_budget; ///< after a failure: the budget refused it, not the driver
};

/**
 * `*memory` is zeroed after a failure, but for `is_beyond_budget`. Nothing is counted then.
 * VK_ERROR_OUT_OF_DEVICE_MEMORY for tile memory beyond the budget, which is not logged.
 * VK_ERROR_UNKNOWN, logged, if the callbacks returned something else than was requested.
 */
VkResult slc_memory_allocate(const struct slc_vk *vk, const struct slc_memory_request *request,
                             struct slc_memory *memory);
/** A zeroed block is allowed, and what it is afterwards. */
void slc_memory_free(const struct slc_vk *vk, struct slc_memory *memory);

/** Memory that `from` counts is counted by `to` from now on. */
void slc_memory_move(const struct slc_vk *from, const struct slc_vk *to,
                     const struct slc_memory *memory);

#endif /* SLC_VULKAN_MEMORY_H */
