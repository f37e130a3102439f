/** What damaged traces are made and played with. */
#ifndef TESTS_REPLAY_DAMAGE_H
#define TESTS_REPLAY_DAMAGE_H

#include <sluice/replay.h>

/** Malloc up to a limit, because a few damaged bytes can ask for a texture of a billion tiles. */
struct limited_memory {
    uint64_t left, limit;
    SluiceAllocationCallbacks callbacks; ///< pass a pointer to this
};

void limited_memory_init(struct limited_memory *memory, uint64_t limit);

/** Makes every checksum of a SLUICERT trace right again, as far as its blocks can be followed. */
void reseal_trace(uint8_t *data, size_t size);

/** Plays with little memory; aborts if any of it is lost. */
SluiceResult play_damaged(const void *data, size_t size, SluiceReplayResult *result);

/** Plays call by call, with little memory and checkpoints; aborts if any memory is lost. `state` is
 *  as it was if there was nothing to play. */
SluiceResult play_damaged_by_calls(const void *data, size_t size, SluiceTracePlayerState *state);

#endif /* TESTS_REPLAY_DAMAGE_H */
