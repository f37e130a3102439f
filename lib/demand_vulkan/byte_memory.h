/**
 * Slots of GPU buffers as places of byte pages, within a budget of device memory.
 *
 * Buffers ("chunks") are cut into slabs of 2 MiB. The slots of a slab have one stride: the size of
 * a page, rounded up to 16 bytes. A slab without pages may get another stride. Chunks are made when
 * no slab is left, each as large as all chunks before it, and destroyed after being empty a while.
 *
 * A slot that was given back can be taken at once, because launches run in the order of their
 * submission: the copy into the slot runs after all shaders that read it. A free slot keeps its
 * bytes until it is taken. The slot that was given back longest ago is taken first, so that evicted
 * pages can be restored for long. Externally synchronized.
 */
#ifndef SLC_DEMAND_VULKAN_BYTE_MEMORY_H
#define SLC_DEMAND_VULKAN_BYTE_MEMORY_H

#include "demand/page_residency.h"
#include "vulkan/caps.h"
#include "vulkan/memory.h"

#include <sluice/shared/bindings.h>

#define SLC_BYTE_ALIGNMENT 16u
#define SLC_BYTE_SLAB_SIZE (2u << 20)
#define SLC_MAX_BYTE_PAGE_SIZE (1u << 20)
#define SLC_BYTE_KINDS 256u /* strides; recordings allow no more */

struct slc_byte_slot {
    uint32_t previous, next; ///< free: neighbors in the ring
    uint32_t owner;          ///< free: page whose bytes are in the slot; SLC_NO_PAGE: none
    bool held;
};

struct slc_byte_slab {
    uint32_t stride; ///< bytes
    uint32_t slot_count, free_count;
    struct slc_byte_slot *slots; ///< owned; slot_count, and the head of the ring. NULL: not in use
};

enum slc_byte_chunk_state {
    SLC_BYTE_CHUNK_FREE = 0,
    SLC_BYTE_CHUNK_LIVE,
    SLC_BYTE_CHUNK_RETIRING ///< new launches do not see it; waits for earlier launches
};

struct slc_byte_chunk {
    enum slc_byte_chunk_state state;
    VkBuffer buffer;
    struct slc_memory memory;
    VkDeviceAddress address;     ///< 0 without addresses
    struct slc_byte_slab *slabs; ///< owned
    uint32_t slab_count, held_count;
    uint64_t tick;   ///< LIVE: last tick in which the chunk was not empty
    uint64_t launch; ///< RETIRING: last launch that may see the chunk
};

struct slc_byte_memory {
    const struct slc_vk *vk; ///< borrowed, like the next field
    const struct slc_caps *caps;
    SluiceAllocationCallbacks cb;
    PFN_vkGetBufferDeviceAddress get_address; ///< NULL: values are not addresses
    struct slc_byte_chunk chunks[SLUICE_DEMAND_BYTE_CHUNKS];
    uint32_t strides[SLC_BYTE_KINDS]; ///< by kind of page
    uint32_t kind_count;
    uint64_t budget; ///< bytes, hard limit of `size`
    uint64_t size;   ///< bytes of all chunks
    uint32_t chunk_count;
    uint64_t generation;   ///< generation of the buffers that shaders see, from 1 on
    uint32_t last;         ///< slab that a slot was taken from last
    uint64_t held_size;    ///< bytes of slots that are held
    uint64_t tick;         ///< launches begun, including abandoned ones
    uint64_t refused_tick; ///< 1 + the tick in which the device refused a chunk; 0: not refused
    uint64_t evicted_count;
    bool short_of; ///< a request found no slot since the last launch
};

/** Initializes without allocating. `addresses`: the device has bufferDeviceAddress enabled. */
void slc_byte_memory_init(struct slc_byte_memory *memory, const struct slc_vk *vk,
                          const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                          uint64_t budget, bool addresses);
/** Frees all chunks. No commands in progress may use them. `memory` may be zeroed. */
void slc_byte_memory_finish(struct slc_byte_memory *memory);

/** Returns the bytes from one page of this size to the next. */
static inline uint32_t slc_byte_stride(uint32_t page_size)
{
    return (page_size + SLC_BYTE_ALIGNMENT - 1) / SLC_BYTE_ALIGNMENT * SLC_BYTE_ALIGNMENT;
}

/** Gets the kind of pages of a stride; it never changes. Returns false if all kinds are taken. */
bool slc_byte_memory_kind(struct slc_byte_memory *memory, uint32_t stride, uint32_t *kind);

/** Returns the functions for slc_residency_set_class. */
struct slc_page_memory slc_byte_memory_interface(struct slc_byte_memory *memory);

/** Gets buffer and byte offset of a place. */
void slc_byte_place(uint32_t place, uint32_t stride, uint32_t *chunk, uint64_t *offset);
/** Returns the value of a place for shaders: its address, or chunk << 32 | byte offset. */
uint64_t slc_byte_value(const struct slc_byte_memory *memory, uint32_t place, uint32_t stride,
                        bool address);

/** Frees chunks that have been empty for a while, under `pressure` sooner. Call it when `launch`
 *  begins. Launches up to `processed` are complete. */
void slc_byte_memory_begin(struct slc_byte_memory *memory, uint64_t launch, uint64_t processed,
                           bool pressure);

/** True if pages may soon be evicted, so that shaders should report the pages that they use. */
bool slc_byte_memory_is_filling(const struct slc_byte_memory *memory);

#endif /* SLC_DEMAND_VULKAN_BYTE_MEMORY_H */
