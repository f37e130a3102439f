/** Threads that work side by side: one for each device. */
#ifndef SAMPLES_COMMON_CREW_H
#define SAMPLES_COMMON_CREW_H

#include <stdbool.h>
#include <stdint.h>

/** Work of member `index`. False: it failed, which it has said. */
typedef bool (*crew_work)(void *user_data, uint32_t index);

/**
 * Calls `work` once for each of `count` members, each on a thread of its own, and waits for all of
 * them. Member 0 works on the calling thread. Members for which there is no thread work after it.
 * True if all members succeeded.
 */
bool crew_run(uint32_t count, crew_work work, void *user_data);

#endif /* SAMPLES_COMMON_CREW_H */
