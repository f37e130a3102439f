/** A manager of its own, the calls made on it, and the hash over what it decides. */
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

    /** Whether heaps are answered as recorded, or with 0, 1, 2, ... */
    bool scripted;
    struct slc_heap_answer *answers; ///< owned; of the next sluiceGetTilesToMap
    size_t answer_count, answer_capacity, answers_used;
    bool answers_missing;  ///< more heaps were asked for than were answered
    uint32_t next_heap_id; ///< unless scripted

    void *scratch; ///< owned; see slc_player_scratch
    size_t scratch_size;
};

/**
 * Makes the manager. `info` has capacity, tile size and flags; `player` must stay where it is until
 * slc_player_finish. After an error there is nothing to finish.
 */
SluiceResult slc_player_init(struct slc_player *player, const SluiceAllocationCallbacks *cb,
                             const SluiceStreamedTextureManagerCreateInfo *info, bool scripted);
void slc_player_finish(struct slc_player *player);

/** Appends an answer of the heap allocator for the next call. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_player_add_answer(struct slc_player *player, SluiceResult result,
                                   uint32_t heap_id);

/** Room for `count` elements of `size` bytes, at least 1, until the next call that lists. */
void *slc_player_scratch(struct slc_player *player, size_t count, size_t size);

/**
 * Makes one call, prints and hashes it. On entry `call` holds the inputs and, where it is known,
 * the result that the call had: one that failed for want of host memory changed nothing, so it is
 * not made and just hashed, and one refused for a NULL pointer gets that pointer again. On return
 * it holds the outputs, lists in scratch.
 *
 * Errors: OUT_OF_HOST_MEMORY, if that was not the known result.
 */
SluiceResult slc_player_call(struct slc_player *player, struct slc_call *call);

#endif /* SLC_REPLAY_PLAYER_H */
