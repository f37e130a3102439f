/** Memory that all requests need, by the number of levels by which requests become coarser. */
#ifndef SLUICE_VIEW_BUDGET_NEED_H
#define SLUICE_VIEW_BUDGET_NEED_H

#include <stdint.h>

#define BUDGET_NEED_LEVELS 16u

struct budget_need {
    uint64_t tails;                     ///< tiles of mip tails, which are never evicted
    uint64_t tiles[BUDGET_NEED_LEVELS]; ///< requested tiles outside mip tails, by levels added
};

/**
 * Adds a texture. `map`: finest requested level of each tile of level 0, as
 * sluiceWriteRequestedLevels writes it, tightly packed. The map is overwritten. `level_count`:
 * levels finer than the mip tail.
 */
void budget_need_add(struct budget_need *need, uint8_t *map, uint32_t width, uint32_t height,
                     uint32_t level_count, uint32_t tail_tiles);
/** Returns the bytes that requests need with `levels` added. */
uint64_t budget_need_bytes(const struct budget_need *need, uint32_t levels);
/** Returns the levels to add so that requests fit a budget. Interpolates between whole levels by
 *  bytes. 0 if the budget suffices. Returns the last level if mip tails alone exceed the budget. */
double budget_need_levels(const struct budget_need *need, uint64_t budget);

#endif /* SLUICE_VIEW_BUDGET_NEED_H */
