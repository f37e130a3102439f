#include "vulkan/region_arena.h"

#include "base/alloc.h"

#include <assert.h>
#include <string.h>

static uint32_t round_up(uint32_t count)
{
    return (count + SLC_REGION_ALIGNMENT - 1) & ~(SLC_REGION_ALIGNMENT - 1);
}

SluiceResult slc_region_arena_init(struct slc_region_arena *arena,
                                   const SluiceAllocationCallbacks *cb, uint32_t size,
                                   uint32_t max_ranges)
{
    /* n ranges have at most n + 1 gaps around them */
    *arena = (struct slc_region_arena){.gap_capacity = max_ranges + 1,
                                       .size = size & ~(SLC_REGION_ALIGNMENT - 1)};
    arena->gaps = slc_alloc(cb, arena->gap_capacity, sizeof *arena->gaps);
    if (!arena->gaps)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    arena->gaps[0] = (struct slc_region_gap){0, arena->size};
    arena->gap_count = arena->size > 0;
    return SLUICE_SUCCESS;
}

void slc_region_arena_finish(struct slc_region_arena *arena, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, arena->gaps, arena->gap_capacity, sizeof *arena->gaps);
    *arena = (struct slc_region_arena){0};
}

SluiceResult slc_region_arena_reserve(struct slc_region_arena *arena,
                                      const SluiceAllocationCallbacks *cb, uint32_t max_ranges)
{
    if (max_ranges < arena->gap_capacity)
        return SLUICE_SUCCESS;
    uint32_t capacity = 2 * max_ranges;
    struct slc_region_gap *gaps = slc_alloc(cb, capacity, sizeof *gaps);
    if (!gaps)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memcpy(gaps, arena->gaps, arena->gap_count * sizeof *gaps);
    slc_free(cb, arena->gaps, arena->gap_capacity, sizeof *gaps);
    arena->gaps = gaps;
    arena->gap_capacity = capacity;
    return SLUICE_SUCCESS;
}

static void remove_gap(struct slc_region_arena *arena, uint32_t at)
{
    arena->gap_count--;
    memmove(&arena->gaps[at], &arena->gaps[at + 1], (arena->gap_count - at) * sizeof *arena->gaps);
}

bool slc_region_arena_take(struct slc_region_arena *arena, uint32_t count, uint32_t *first)
{
    if (count == 0 || count > arena->size)
        return false;
    count = round_up(count);
    for (uint32_t i = 0; i < arena->gap_count; i++) {
        struct slc_region_gap *gap = &arena->gaps[i];
        if (gap->count < count)
            continue;
        *first = gap->first;
        gap->first += count;
        gap->count -= count;
        if (gap->count == 0)
            remove_gap(arena, i);
        return true;
    }
    return false;
}

void slc_region_arena_give(struct slc_region_arena *arena, uint32_t first, uint32_t count)
{
    count = round_up(count);
    uint32_t at = 0;
    while (at < arena->gap_count && arena->gaps[at].first < first)
        at++;
    bool joins_left = at > 0 && arena->gaps[at - 1].first + arena->gaps[at - 1].count == first;
    bool joins_right = at < arena->gap_count && first + count == arena->gaps[at].first;
    if (joins_left && joins_right) {
        arena->gaps[at - 1].count += count + arena->gaps[at].count;
        remove_gap(arena, at);
    } else if (joins_left) {
        arena->gaps[at - 1].count += count;
    } else if (joins_right) {
        arena->gaps[at].first = first;
        arena->gaps[at].count += count;
    } else {
        assert(arena->gap_count < arena->gap_capacity);
        memmove(&arena->gaps[at + 1], &arena->gaps[at],
                (arena->gap_count - at) * sizeof *arena->gaps);
        arena->gaps[at] = (struct slc_region_gap){first, count};
        arena->gap_count++;
    }
}
