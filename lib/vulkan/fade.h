/**
 * How fast regions get sharper: texels of the MinMip buffer sink in steps of 1/256 level from what
 * was shown to what is resident. They rise at once, because what they stand for is gone then.
 */
#ifndef SLC_VULKAN_FADE_H
#define SLC_VULKAN_FADE_H

#include <stdbool.h>
#include <stdint.h>

#include <sluice/shared/texture_table.h>

/** The longest time per level: products with it stay below 2^64. */
#define SLC_MAX_FADE_TIME ((uint64_t)1 << 40)

struct slc_fade_clock {
    uint64_t time_per_level; ///< 0: at once
    uint64_t last, rest;     ///< time; time * 256 that was not enough for a step
};

/** How many steps are due; `now` is never below that of the call before. */
uint16_t slc_fade_clock_advance(struct slc_fade_clock *clock, uint64_t now);

/** The texel of a region once nothing fades: of a level of the manager's MinMip map. */
static inline uint16_t slc_settled_texel(uint8_t level)
{
    return (uint16_t)(level * SLUICE_SHOWN_STEPS + (level ? SLUICE_SHOWN_MARGIN : 0));
}

/** Moves a row of texels towards its levels; true if some are not there yet. */
bool slc_fade_row(const uint8_t *levels, uint16_t *texels, uint32_t count, uint16_t steps);

#endif /* SLC_VULKAN_FADE_H */
