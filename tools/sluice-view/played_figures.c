#include "played.h"

static const char *const names[PLAYED_FIGURES] = {"tiles_requested",
                                                  "tiles_allocated",
                                                  "tiles_mapped",
                                                  "tiles_standby",
                                                  "tiles_canceled",
                                                  "tiles_failed",
                                                  "tiles_given_up",
                                                  "heaps",
                                                  "slots_free",
                                                  "heaps_allowed",
                                                  "bias_sixteenths",
                                                  "handed_out",
                                                  "loaded",
                                                  "evicted",
                                                  "canceled",
                                                  "failed",
                                                  "restored",
                                                  "evicted_wanted",
                                                  "stale",
                                                  "feedback_maps",
                                                  "feedback_texels",
                                                  "heaps_refused",
                                                  "frame_microseconds"};

const char *played_figure_name(enum played_figure figure)
{
    return names[figure];
}

uint32_t played_wanted(const struct played_frame *frame)
{
    const uint32_t *f = frame->figures;
    return f[PLAYED_REQUESTED] + f[PLAYED_LOADING] + f[PLAYED_RESIDENT] + f[PLAYED_FAILING] +
           f[PLAYED_GIVEN_UP];
}

uint32_t played_find(const struct played *p, uint32_t from, enum played_figure figure,
                     int direction)
{
    for (uint32_t i = from + (uint32_t)direction; i < p->frame_count; i += (uint32_t)direction)
        if (p->frames[i].figures[figure] > 0)
            return i;
    return UINT32_MAX;
}

uint32_t played_peak(const struct played *p, enum played_figure figure, uint32_t first,
                     uint32_t end)
{
    uint32_t peak = 0;
    for (uint32_t i = first; i < end;) {
        const bool block = i % PLAYED_BLOCK == 0 && end - i >= PLAYED_BLOCK;
        const uint32_t value = block
                                   ? p->peaks[(size_t)(i / PLAYED_BLOCK) * PLAYED_FIGURES + figure]
                                   : p->frames[i].figures[figure];
        peak = value > peak ? value : peak;
        i += block ? PLAYED_BLOCK : 1;
    }
    return peak;
}

uint32_t played_longest(const struct played *p)
{
    uint32_t longest = 0;
    for (uint32_t i = 1; i < p->frame_count; i++)
        if (p->frames[i].figures[PLAYED_MICROSECONDS] >
            p->frames[longest].figures[PLAYED_MICROSECONDS])
            longest = i;
    return longest;
}
