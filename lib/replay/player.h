/** Player: owns a manager, makes calls on it, and hashes its decisions. */
#ifndef SLC_REPLAY_PLAYER_H
#define SLC_REPLAY_PLAYER_H

#include "core/observer.h"
#include "replay/dump.h"

struct slc_heap_answer {
    SluiceResult result;
    uint32_t heap_id;
};

struct slc_player {
    SluiceAllocationCallbacks cb;
    SluiceStreamedTextureManager *manager; ///< owned
    uint64_t hash;                         ///< over all decisions so far
    uint64_t event_count;                  ///< calls made so far
    struct slc_dump dump;

    /** True: heap answers come from the recording. False: heaps get 0, 1, 2, ... */
    bool scripted;
    struct slc_heap_answer *answers; ///< owned; for the next sluiceGetTilesToMap
    size_t answer_count, answer_capacity, answers_used;
    bool answers_missing;  ///< the manager requested more heaps than recorded
    uint32_t next_heap_id; ///< used if not scripted

    void *scratch; ///< owned; see slc_player_scratch
    size_t scratch_size;
};

/**
 * Creates the manager. `info` has capacity, tile size and flags. `player` must not move until
 * slc_player_finish. Do not finish after an error.
 */
SluiceResult slc_player_init(struct slc_player *player, const SluiceAllocationCallbacks *cb,
                             const SluiceStreamedTextureManagerCreateInfo *info, bool scripted);
void slc_player_finish(struct slc_player *player);

/** Appends an answer of the heap allocator for the next call. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_player_add_answer(struct slc_player *player, SluiceResult result,
                                   uint32_t heap_id);

/** Returns room for `count` (at least 1) elements of `size` bytes, valid until the next list call.
 */
void *slc_player_scratch(struct slc_player *player, size_t count, size_t size);

/**
 * Makes one call, prints and hashes it. On entry, `call` holds the inputs and the recorded result,
 * if known. A call recorded as OUT_OF_HOST_MEMORY changed nothing, so it is only hashed. A call
 * recorded as NULL_POINTER gets a NULL pointer again. On return, `call` holds the outputs, with
 * lists in scratch.
 *
 * Errors: OUT_OF_HOST_MEMORY, unless this was the recorded result.
 */
SluiceResult slc_player_call(struct slc_player *player, struct slc_call *call);

#endif /* SLC_REPLAY_PLAYER_H */
