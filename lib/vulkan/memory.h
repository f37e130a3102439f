/** Device memory, counted: all of it is allocated and freed here. */
#ifndef SLC_VULKAN_MEMORY_H
#define SLC_VULKAN_MEMORY_H

#include "vulkan/dispatch.h"

/** Bytes allocated now. `host` is memory that is mapped, `device` all other. */
struct slc_memory_use {
    uint64_t device, host;
};

enum slc_memory_kind { SLC_MEMORY_DEVICE, SLC_MEMORY_HOST };

/** `*memory` is VK_NULL_HANDLE after a failure, and nothing is counted. */
VkResult slc_memory_allocate(const struct slc_vk *vk, uint64_t size, uint32_t type,
                             enum slc_memory_kind kind, VkDeviceMemory *memory);
/** With the size and kind that it was allocated with. VK_NULL_HANDLE is allowed. */
void slc_memory_free(const struct slc_vk *vk, VkDeviceMemory memory, uint64_t size,
                     enum slc_memory_kind kind);

/** Memory that `from` counts is counted by `to` from now on. */
void slc_memory_move(const struct slc_vk *from, const struct slc_vk *to, uint64_t size,
                     enum slc_memory_kind kind);

#endif /* SLC_VULKAN_MEMORY_H */
