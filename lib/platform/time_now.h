/** Time that runs at a steady rate. */
#ifndef SLC_PLATFORM_TIME_NOW_H
#define SLC_PLATFORM_TIME_NOW_H

#include <stdint.h>

/** Nanoseconds since some moment. Never decreases, also when somebody sets the clock. Any thread.
 */
uint64_t slc_monotonic_time(void);

#endif /* SLC_PLATFORM_TIME_NOW_H */
