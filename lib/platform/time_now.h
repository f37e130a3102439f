/** Monotonic time. */
#ifndef SLC_PLATFORM_TIME_NOW_H
#define SLC_PLATFORM_TIME_NOW_H

#include <stdint.h>

/** Returns nanoseconds since an arbitrary moment. Never decreases, even if the clock is set. Any
 * thread. */
uint64_t slc_monotonic_time(void);

#endif /* SLC_PLATFORM_TIME_NOW_H */
