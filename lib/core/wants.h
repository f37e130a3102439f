/** Turns feedback maps into wanted tiles. A merge is prepared, which may fail, then committed. */
#ifndef SLC_CORE_WANTS_H
#define SLC_CORE_WANTS_H

#include "core/state.h"

/** Resources for the commits of one call. */
struct slc_wants_need {
    uint64_t nodes; ///< most nodes that the commits can take
    size_t scratch; ///< bytes of scratch that their maps have taken
};

/** Returns the scratch of a commit besides the map: shape->work_size bytes. */
static inline uint8_t *slc_wants_work(slc_manager *m, const struct slc_managed_texture *t)
{
    return m->scratch + m->scratch_room - t->shape->work_size;
}
/** Reserves scratch: `bytes` padded bytes for the maps of one call, and `work` for one texture. */
SluiceResult slc_wants_reserve_scratch(slc_manager *m, uint64_t bytes, size_t work);

/**
 * Writes the requested levels of a map into the scratch. Changes nothing that can be seen. `users`:
 * number of textures with the texture's history that will get the map.
 */
SluiceResult slc_wants_prepare(slc_manager *m, struct slc_managed_texture *t,
                               const SluiceFeedbackDesc *feedback, uint32_t users,
                               struct slc_wants_need *need);

/** Maps a value v of a map to the level it requests: clamp(min(v, coarsest) + up - down, lowest,
 * last). */
struct slc_levels {
    uint8_t up, down; ///< at most 32; at least one is 0
    uint8_t coarsest; ///< coarsest level of the texture whose map holds the values
    uint8_t lowest, last;
};

/** Takes bytes of the scratch, padded. */
uint8_t *slc_wants_take_scratch(slc_manager *m, size_t size, struct slc_wants_need *need);
/** Takes room for the texture's map from the scratch. */
uint8_t *slc_wants_take_map(slc_manager *m, const struct slc_managed_texture *t,
                            struct slc_wants_need *need);
/**
 * Writes the levels that `values` request, one per region, to `next`. `next` may be `values`. Adds
 * to `need` the resources that merging the map can take.
 */
void slc_wants_set_map(slc_manager *m, struct slc_managed_texture *t, const uint8_t *values,
                       const struct slc_levels *levels, uint8_t *next, struct slc_wants_need *need);

/** A tile that becomes wanted or no longer is. */
struct slc_move {
    uint32_t tile;
    uint8_t level;
    bool wanted;
};

/** Moves of one map, repeated for other textures that get the map. */
struct slc_move_log {
    struct slc_move *moves; ///< capacity: one per regular tile
    uint32_t count;
};

/** Merges history->next and writes the moves to `log` unless that is NULL. Cannot fail. */
void slc_wants_commit(slc_manager *m, struct slc_managed_texture *t, uint64_t time,
                      uint64_t timeout, struct slc_move_log *log);
/** Repeats a commit for a texture `t` that shares the history of `leader`, just committed. */
void slc_wants_repeat(slc_manager *m, const struct slc_managed_texture *leader,
                      struct slc_managed_texture *t, uint64_t time, uint64_t timeout,
                      const struct slc_move_log *log);

/**
 * Counts the regular tiles that a restored history wants. The tiles themselves are restored
 * elsewhere. Scratch for the texture's work must be reserved.
 */
void slc_wants_restore(slc_manager *m, struct slc_managed_texture *t);

/** Abandons a prepared merge: frees the state and history that it made. */
void slc_wants_abandon(slc_manager *m, struct slc_managed_texture *t);

/** Drops the history of a texture: none of its tiles is wanted any more. */
void slc_wants_drop(slc_manager *m, struct slc_managed_texture *t);

#endif /* SLC_CORE_WANTS_H */
