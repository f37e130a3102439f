#include "vulkan/fade.h"

uint16_t slc_fade_clock_advance(struct slc_fade_clock *clock, uint64_t now)
{
    uint64_t passed = now - clock->last;
    clock->last = now;
    if (clock->time_per_level == 0 || passed / SLUICE_SHOWN_STEPS >= clock->time_per_level) {
        clock->rest = 0;
        return UINT16_MAX;
    }
    uint64_t due = clock->rest + passed * SLUICE_SHOWN_STEPS;
    clock->rest = due % clock->time_per_level;
    uint64_t steps = due / clock->time_per_level;
    return steps < UINT16_MAX ? (uint16_t)steps : UINT16_MAX;
}

/* Without branches, so that compilers vectorize the loop. */
bool slc_fade_row(const uint8_t *levels, uint16_t *texels, uint32_t count, uint16_t steps)
{
    uint16_t moving = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint16_t settled = slc_settled_texel(levels[i]), texel = texels[i];
        uint16_t next = texel > steps ? (uint16_t)(texel - steps) : 0;
        /* a region that shows nothing becomes sharp at once: there is no level to fade from */
        next = texel >= SLUICE_SHOWN_NOTHING ? 0 : next;
        next = next > settled ? next : settled;
        moving |= next ^ settled;
        texels[i] = next;
    }
    return moving != 0;
}
