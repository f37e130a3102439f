/** Threads that run side by side, one for each device. */
#ifndef SAMPLES_COMMON_CREW_H
#define SAMPLES_COMMON_CREW_H

#include <stdbool.h>
#include <stdint.h>

/** Work of member `index`. Reports its errors itself and returns false. */
typedef bool (*crew_work)(void *user_data, uint32_t index);

/**
 * Calls `work` once for each of `count` members, each on its own thread, and waits for all of them.
 * Member 0 runs on the calling thread. Members without a thread run after it. Returns whether all
 * succeeded.
 */
bool crew_run(uint32_t count, crew_work work, void *user_data);

#endif /* SAMPLES_COMMON_CREW_H */
