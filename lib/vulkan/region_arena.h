/**
 * Hands out ranges of region indices: a texture's words in the feedback buffer and bytes in the
 * MinMip buffer. First fit over a sorted list of gaps; textures come and go rarely.
 */
#ifndef SLC_VULKAN_REGION_ARENA_H
#define SLC_VULKAN_REGION_ARENA_H

#include <sluice/base.h>

/** Alignment of ranges, so that no two textures share a MinMip word. */
#define SLC_REGION_ALIGNMENT 4u

struct slc_region_gap {
    uint32_t first, count;
};

struct slc_region_arena {
    struct slc_region_gap *gaps; ///< owned; sorted, apart from each other
    uint32_t gap_count, gap_capacity;
    uint32_t size;
};

/** Makes an arena for at most `max_ranges` ranges at a time. */
SluiceResult slc_region_arena_init(struct slc_region_arena *arena,
                                   const SluiceAllocationCallbacks *cb, uint32_t size,
                                   uint32_t max_ranges);
void slc_region_arena_finish(struct slc_region_arena *arena, const SluiceAllocationCallbacks *cb);

/** Raises the number of ranges to `max_ranges`. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_region_arena_reserve(struct slc_region_arena *arena,
                                      const SluiceAllocationCallbacks *cb, uint32_t max_ranges);

/** Takes a range. False if no gap is large enough. */
bool slc_region_arena_take(struct slc_region_arena *arena, uint32_t count, uint32_t *first);
/** Gives back a range exactly as it was taken. */
void slc_region_arena_give(struct slc_region_arena *arena, uint32_t first, uint32_t count);

#endif /* SLC_VULKAN_REGION_ARENA_H */
