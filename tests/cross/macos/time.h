/* clocks. Those of macOS 10.12 and later. */
#ifndef MACOS_STUB_TIME_H
#define MACOS_STUB_TIME_H

#include <sys/types.h>

typedef int clockid_t;
#define CLOCK_REALTIME 0
#define CLOCK_MONOTONIC 6

int clock_gettime(clockid_t clock, struct timespec *time);
time_t time(time_t *now);

#endif /* MACOS_STUB_TIME_H */
