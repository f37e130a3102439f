/**
 * Frames that detail takes to arrive.
 *
 * A wait begins where a region needs a finer level than in the previous frame. It ends with the
 * first frame that shows the level, and lasts 0 frames if that is the same frame. It also ends when
 * the region no longer needs the level, or at the end of the run.
 */
#ifndef SAMPLES_STREAMING_NEEDS_WAIT_H
#define SAMPLES_STREAMING_NEEDS_WAIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct needs_wait_event {
    size_t region;
    uint64_t since; ///< first frame of the wait
    uint8_t level;
};

struct needs_wait {
    uint8_t *before; ///< owned; per region: level needed in the previous frame
    size_t region_count;
    struct needs_wait_event *open; ///< owned; waits that have not ended
    size_t open_count, open_capacity;
    uint64_t *lengths; ///< owned; number of waits by length in frames
    size_t length_capacity;
    uint64_t count, unmet; ///< ended waits, and those of them whose level never came
    uint64_t frame;        ///< number of the next frame
};

/** Returns whether a texel of the MinMip buffer shows the level. */
bool needs_is_shown(uint16_t shown, uint8_t level);

/** Returns false when out of memory. */
bool needs_wait_begin(struct needs_wait *wait, size_t region_count);
void needs_wait_finish(struct needs_wait *wait);

/** Adds a frame. `levels`: needed levels, 255 for none. `shown`: texels of the MinMip buffer.
 * Returns false when out of memory. */
bool needs_wait_add_frame(struct needs_wait *wait, const uint8_t *levels, const uint16_t *shown);

/** Ends all waits. Returns false when out of memory. */
bool needs_wait_end(struct needs_wait *wait);

/** Returns the number of frames that `share` of the waits do not exceed. NaN without waits. */
double needs_wait_quantile(const struct needs_wait *wait, double share);
/** Returns the mean number of frames per wait. NaN without waits. */
double needs_wait_mean(const struct needs_wait *wait);

#endif /* SAMPLES_STREAMING_NEEDS_WAIT_H */
