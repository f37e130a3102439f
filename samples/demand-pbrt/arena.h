/** Parts of a few large buffers, because devices allow only some thousand allocations. */
#ifndef DEMAND_PBRT_ARENA_H
#define DEMAND_PBRT_ARENA_H

#include "../../tools/common/gpu.h"

struct arena_chunk;

/** Zeroed, except `usage` and `mapped`, is empty. */
struct arena {
    VkBufferUsageFlags usage;
    bool mapped; ///< the host writes to it
    struct arena_chunk *chunks;
    uint64_t size; ///< bytes of all chunks
    uint64_t used; ///< bytes of all parts
};

struct arena_part {
    struct arena_chunk *chunk; ///< NULL: none
    VkBuffer buffer;
    VkDeviceSize offset, size;
    VkDeviceAddress address;
    void *mapped;
};

/** Takes `size` bytes at a multiple of 256. Reports errors on stderr. */
bool arena_take(const struct gpu *gpu, struct arena *arena, VkDeviceSize size,
                struct arena_part *part);
/** Returns a part. A zeroed one is allowed. Frees chunks that become empty. */
void arena_give(const struct gpu *gpu, struct arena *arena, struct arena_part *part);
void arena_finish(const struct gpu *gpu, struct arena *arena);

#endif /* DEMAND_PBRT_ARENA_H */
