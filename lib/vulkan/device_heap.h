/**
 * Heaps of tile slots as device memory, one block each. Spare heaps hold no tiles: they are made
 * ahead or stay when they are released, up to a size.
 */
#ifndef SLC_VULKAN_DEVICE_HEAP_H
#define SLC_VULKAN_DEVICE_HEAP_H

#include "vulkan/memory.h"

struct slc_device_heap {
    struct slc_memory memory; ///< zeroed: free id
    bool spare;
};

struct slc_device_heaps {
    struct slc_device_heap *at; ///< owned; by heap id
    uint32_t capacity;
    uint64_t total_size; ///< bytes, with spare heaps
    uint64_t kept_size;  ///< bytes of heaps, spare ones included, that are not freed when released
};

/** Makes spare heaps until there are kept_size bytes or `max_count` heaps (0: any number), or the
 *  device refuses one. */
void slc_device_heaps_prepare(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb, uint64_t size,
                              uint32_t memory_type, uint32_t max_count);
/** Frees spare heaps until `wanted` bytes are free, or all of them. Returns the bytes. */
uint64_t slc_device_heaps_free_spare(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                                     uint64_t wanted);

/** Allocates a heap. OUT_OF_DEVICE_MEMORY, not logged, if budget or device refuse it. */
SluiceResult slc_device_heaps_allocate(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                                       const SluiceAllocationCallbacks *cb, uint64_t size,
                                       uint32_t memory_type, uint32_t *heap_id);
/** Releases a heap that nothing is bound to. */
void slc_device_heaps_release(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                              uint32_t heap_id);
void slc_device_heaps_finish(struct slc_device_heaps *heaps, const struct slc_vk *vk,
                             const SluiceAllocationCallbacks *cb);

#endif /* SLC_VULKAN_DEVICE_HEAP_H */
