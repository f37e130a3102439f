#include "core/feedback_lattice.h"

#include <math.h>

enum { SIDE = 8, PHASES = SLC_LATTICE_PHASES };

/** Lists the lattice's position in each of its frames: y * 8 + x. */
static void list_places(uint8_t places[PHASES])
{
    for (uint32_t f = 0; f < PHASES; f++) {
        uint32_t x = (f & 1) << 2 | (f & 4) >> 1 | (f & 16) >> 4;
        uint32_t y = (f & 2) << 1 | (f & 8) >> 2 | (f & 32) >> 5;
        places[f] = (uint8_t)(y * SIDE + (x ^ y));
    }
}

/** Returns a bit per frame: the lattice is inside the region that begins at x, y. */
static uint64_t find_phases(const uint8_t places[PHASES], uint32_t x, uint32_t y, uint32_t width,
                            uint32_t height)
{
    uint64_t phases = 0;
    for (uint32_t f = 0; f < PHASES; f++) {
        uint32_t right = (places[f] % SIDE - x) % SIDE, below = (places[f] / SIDE - y) % SIDE;
        phases |= (uint64_t)(right < width && below < height) << f;
    }
    return phases;
}

/** Returns how many of `count` frames from `first` on, `step` apart, come before the first one in
 * `phases`. */
static uint32_t frames_before(uint64_t phases, uint32_t first, uint32_t step, uint32_t count)
{
    uint32_t frame = 0;
    while (frame < count && !(phases >> (first + frame * step) % PHASES & 1))
        frame++;
    return frame;
}

/** Adds to misses[n], n up to `limit`: first frames of 64 whose first n frames miss the region. */
static void count_misses(uint64_t phases, uint32_t step, uint32_t limit,
                         uint32_t misses[PHASES + 1])
{
    for (uint32_t first = 0; first < PHASES; first++) {
        uint32_t before = frames_before(phases, first, step, limit);
        for (uint32_t n = 0; n <= before; n++)
            misses[n]++;
    }
}

/** misses[n]: first frames of 64 from which n frames miss the region in its worst position. */
static void find_misses(uint32_t width, uint32_t height, uint32_t step, uint32_t misses[PHASES + 1])
{
    uint8_t places[PHASES];
    uint32_t limit = step ? PHASES : 1; /* after PHASES frames the positions repeat */
    list_places(places);
    for (uint32_t n = 0; n <= PHASES; n++)
        misses[n] = 0;
    for (uint32_t place = 0; place < PHASES; place++) {
        uint32_t here[PHASES + 1] = {0};
        uint64_t phases = find_phases(places, place % SIDE, place / SIDE, width, height);
        count_misses(phases, step, limit, here);
        for (uint32_t n = 0; n <= PHASES; n++)
            misses[n] =
                here[n < limit ? n : limit] > misses[n] ? here[n < limit ? n : limit] : misses[n];
    }
}

double slc_lattice_miss(uint32_t width, uint32_t height, double frames, uint32_t step)
{
    uint32_t misses[PHASES + 1];
    find_misses(width, height, step, misses);
    return misses[frames < PHASES ? (uint32_t)frames : PHASES] / (double)PHASES;
}

void slc_lattice_frames(uint32_t width, uint32_t height, uint32_t step, double *median,
                        double *longest)
{
    uint32_t misses[PHASES + 1];
    find_misses(width, height, step, misses);
    *median = *longest = INFINITY;
    for (uint32_t n = PHASES; n > 0; n--) {
        *median = misses[n] <= PHASES / 2 ? n : *median;
        *longest = misses[n] == 0 ? n : *longest;
    }
}
