/** The slow line that --source-latency and --source-bandwidth put before a view's sources. */
#ifndef SAMPLES_STREAMING_SLOWNESS_H
#define SAMPLES_STREAMING_SLOWNESS_H

#include <stdatomic.h>
#include <stdbool.h>

#include "../common/slow_source.h"
#include "settings.h"

/** Its clock is the time stamp of the newest frame, so that a slow machine streams the same way. */
struct slowness {
    bool on;
    struct slow_line line;
    atomic_uint_least64_t now;   ///< microseconds
    SluiceImageSource **sources; ///< owned, and so are they
    uint32_t count, capacity;
};

/** Stays off if the settings ask for none. False if out of memory. Must not be moved afterwards. */
bool slowness_begin(struct slowness *slowness, const struct settings *settings, uint32_t capacity);
/** `source` itself where there is none; NULL if out of memory. Lives until slowness_finish. */
SluiceImageSource *slowness_wrap(struct slowness *slowness, SluiceImageSource *source);
void slowness_set_time(struct slowness *slowness, uint64_t now);
/** No source is used any more; a zeroed struct is fine. */
void slowness_finish(struct slowness *slowness);

#endif /* SAMPLES_STREAMING_SLOWNESS_H */
