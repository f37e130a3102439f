/**
 * Fade of regions that get sharper: texels of the MinMip buffer sink from the shown level to the
 * resident level, in steps of 1/256 level. They rise at once, because the finer level is gone then.
 */
#ifndef SLC_VULKAN_FADE_H
#define SLC_VULKAN_FADE_H

#include <stdbool.h>
#include <stdint.h>

#include <sluice/shared/texture_table.h>

/** Longest time per level. Its products stay below 2^64. */
#define SLC_MAX_FADE_TIME ((uint64_t)1 << 40)

struct slc_fade_clock {
    uint64_t time_per_level; ///< 0: at once
    uint64_t last, rest;     ///< last time; remainder of time * 256, less than a step
};

/** Returns the steps that are due at `now`, which must not decrease. */
uint16_t slc_fade_clock_advance(struct slc_fade_clock *clock, uint64_t now);

/** Returns the texel of a region that does not fade, for a level of the manager's MinMip map. */
static inline uint16_t slc_settled_texel(uint8_t level)
{
    return (uint16_t)(level * SLUICE_SHOWN_STEPS + (level ? SLUICE_SHOWN_MARGIN : 0));
}

/** Moves a row of texels towards its levels. Returns whether some still fade. */
bool slc_fade_row(const uint8_t *levels, uint16_t *texels, uint32_t count, uint16_t steps);

#endif /* SLC_VULKAN_FADE_H */
