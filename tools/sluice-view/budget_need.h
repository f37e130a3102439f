/** Memory that requests need, by how many levels they are made coarser. */
#ifndef SLUICE_VIEW_BUDGET_NEED_H
#define SLUICE_VIEW_BUDGET_NEED_H

#include <stdint.h>

#define BUDGET_NEED_LEVELS 16u

struct budget_need {
    uint64_t tails;                     ///< tiles of mip tails, which stay
    uint64_t tiles[BUDGET_NEED_LEVELS]; ///< of finer levels, by levels that are added to requests
};

/**
 * Adds a texture. `map`: finest level that is requested of each tile of level 0, as
 * sluiceWriteRequestedLevels writes it, tightly packed; it is overwritten. `level_count`: levels
 * that are finer than the mip tail.
 */
void budget_need_add(struct budget_need *need, uint8_t *map, uint32_t width, uint32_t height,
                     uint32_t level_count, uint32_t tail_tiles);
/** Bytes with so many levels added, a whole number of them. */
uint64_t budget_need_bytes(const struct budget_need *need, uint32_t levels);
/** Levels to add, between whole ones by bytes, so that a budget is kept to. 0 if it is enough. The
 *  last level there is if mip tails alone are too large. */
double budget_need_levels(const struct budget_need *need, uint64_t budget);

#endif /* SLUICE_VIEW_BUDGET_NEED_H */
