/** Heaps of tile slots as device memory, one block each. */
#ifndef SLC_VULKAN_DEVICE_HEAP_H
#define SLC_VULKAN_DEVICE_HEAP_H

#include "vulkan/memory.h"

struct slc_device_heaps {
    struct slc_memory *memory; ///< owned; by heap id; none: free id
    uint32_t capacity;
    uint64_t total_size;
};

/** OUT_OF_DEVICE_MEMORY when the device refuses: that is the budget, and is not logged. */
SluiceResult slc_device_heaps_allocate(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                                       const SluiceAllocationCallbacks *cb, uint64_t size,
                                       uint32_t memory_type, uint32_t *heap_id);
void slc_device_heaps_release(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                              uint32_t heap_id);
void slc_device_heaps_finish(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                             const SluiceAllocationCallbacks *cb);

#endif /* SLC_VULKAN_DEVICE_HEAP_H */
