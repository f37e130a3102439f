/** The slow line that --source-latency and --source-bandwidth put before a view's sources. */
#ifndef SAMPLES_STREAMING_SLOWNESS_H
#define SAMPLES_STREAMING_SLOWNESS_H

#include <stdatomic.h>
#include <stdbool.h>

#include "../common/slow_source.h"
#include "settings.h"

/** Slow line of a view. Its clock is the time stamp of the newest frame, so that slow machines
 * stream in the same way. */
struct slowness {
    bool on;
    struct slow_line line;
    atomic_uint_least64_t now;   ///< microseconds
    SluiceImageSource **sources; ///< owned, with its elements
    uint32_t count, capacity;
};

/** Stays off if the settings want no delay. Returns false when out of memory. The struct must not
 * move afterwards. */
bool slowness_begin(struct slowness *slowness, const struct settings *settings, uint32_t capacity);
/** Returns a slow source that reads `source`, or `source` itself if the line is off. NULL: out of
 * memory. Lives until slowness_finish. */
SluiceImageSource *slowness_wrap(struct slowness *slowness, SluiceImageSource *source);
void slowness_set_time(struct slowness *slowness, uint64_t now);
/** Call when no source is used any more. A zeroed struct is allowed. */
void slowness_finish(struct slowness *slowness);

#endif /* SAMPLES_STREAMING_SLOWNESS_H */
