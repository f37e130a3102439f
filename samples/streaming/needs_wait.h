/**
 * How long detail takes to arrive, in frames.
 *
 * A wait begins where a region needs a finer level than in the frame before, and ends with the
 * first frame that shows that level; one that shows it at once is a wait of 0. Where the region
 * stops to need the level before that, or the run ends, the wait counts with the frames that it has
 * lasted.
 */
#ifndef SAMPLES_STREAMING_NEEDS_WAIT_H
#define SAMPLES_STREAMING_NEEDS_WAIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct needs_wait_event {
    size_t region;
    uint64_t since; ///< frame
    uint8_t level;
};

struct needs_wait {
    uint8_t *before; ///< owned; per region, what the frame before needed
    size_t region_count;
    struct needs_wait_event *open; ///< owned; waits that go on
    size_t open_count, open_capacity;
    uint64_t *lengths; ///< owned; per number of frames: waits that lasted so long
    size_t length_capacity;
    uint64_t count, unmet; ///< waits that are over, and those of them that were in vain
    uint64_t frame;        ///< the next one
};

/** Whether a texel of the MinMip buffer shows the level. */
bool needs_is_shown(uint16_t shown, uint8_t level);

/** False if there is no memory. */
bool needs_wait_begin(struct needs_wait *wait, size_t region_count);
void needs_wait_finish(struct needs_wait *wait);

/** `levels` 255: the region is not needed; `shown` as in the MinMip buffer. False without memory.
 */
bool needs_wait_add_frame(struct needs_wait *wait, const uint8_t *levels, const uint16_t *shown);

/** The run is over. False without memory. */
bool needs_wait_end(struct needs_wait *wait);

/** The frames that `share` of the waits do not exceed; NaN if there were none. */
double needs_wait_quantile(const struct needs_wait *wait, double share);
/** Frames per wait; NaN if there were none. */
double needs_wait_mean(const struct needs_wait *wait);

#endif /* SAMPLES_STREAMING_NEEDS_WAIT_H */
