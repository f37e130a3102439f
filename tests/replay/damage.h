/** Makes and plays damaged traces. */
#ifndef TESTS_REPLAY_DAMAGE_H
#define TESTS_REPLAY_DAMAGE_H

#include <sluice/replay.h>

/** Malloc with a limit, because a few damaged bytes can request a texture of a billion tiles. */
struct limited_memory {
    uint64_t left, limit;
    SluiceAllocationCallbacks callbacks; ///< pass a pointer to this
};

void limited_memory_init(struct limited_memory *memory, uint64_t limit);

/** Corrects every checksum of a SLUICERT trace, as far as its blocks can be followed. */
void reseal_trace(uint8_t *data, size_t size);

/** Plays with little memory. Aborts after a leak. */
SluiceResult play_damaged(const void *data, size_t size, SluiceReplayResult *result);

/** Plays call by call with little memory and checkpoints. Aborts after a leak. `state` is unchanged
 * if nothing was played. */
SluiceResult play_damaged_by_calls(const void *data, size_t size, SluiceTracePlayerState *state);

#endif /* TESTS_REPLAY_DAMAGE_H */
