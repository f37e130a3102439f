/** Feedback maps to want counts. A merge is prepared, which may fail, and then committed. */
#ifndef SLC_CORE_WANTS_H
#define SLC_CORE_WANTS_H

#include "core/state.h"

/** What the commits of one call will need at most, and how much scratch their maps have taken. */
struct slc_wants_need {
    uint64_t nodes;
    size_t scratch; ///< bytes in use
};

/** Where the scratch is that a commit needs beside the map: shape->work_size bytes. */
static inline uint8_t *slc_wants_work(slc_manager *m, const struct slc_managed_texture *t)
{
    return m->scratch + m->scratch_room - t->shape->work_size;
}
/** Room for the maps of one call, `bytes` padded bytes in all, and for one texture's work. */
SluiceResult slc_wants_reserve_scratch(slc_manager *m, uint64_t bytes, size_t work);

/**
 * Puts what the map asks for into the scratch. Changes nothing that can be seen. All `users` of the
 * texture's history will get the map.
 */
SluiceResult slc_wants_prepare(slc_manager *m, struct slc_managed_texture *t,
                               const SluiceFeedbackDesc *feedback, uint32_t users,
                               struct slc_wants_need *need);

/** From the values of a map to what they ask for: clamp(min(v, coarsest) + up - down, lowest,
 * last). */
struct slc_levels {
    uint8_t up, down; ///< at most 32, one of them 0
    uint8_t coarsest; ///< of the texture that the values are for
    uint8_t lowest, last;
};

/** Takes bytes of the scratch, padded. */
uint8_t *slc_wants_take_scratch(slc_manager *m, size_t size, struct slc_wants_need *need);
/** Takes room for the texture's map from the scratch. */
uint8_t *slc_wants_take_map(slc_manager *m, const struct slc_managed_texture *t,
                            struct slc_wants_need *need);
/**
 * Puts what `values`, one per region, ask for into `next`, which may be where they are, and adds
 * what merging it can need.
 */
void slc_wants_set_map(slc_manager *m, struct slc_managed_texture *t, const uint8_t *values,
                       const struct slc_levels *levels, uint8_t *next, struct slc_wants_need *need);

/** A tile that becomes wanted or no longer is. */
struct slc_move {
    uint32_t tile;
    uint8_t level;
    bool wanted;
};

/** The moves of one map, for other textures that get it. */
struct slc_move_log {
    struct slc_move *moves; ///< room for one per regular tile
    uint32_t count;
};

/** Merges history->next and writes the moves to `log` unless that is NULL. Cannot fail. */
void slc_wants_commit(slc_manager *m, struct slc_managed_texture *t, uint64_t time,
                      uint64_t timeout, struct slc_move_log *log);
/** The same for a texture that shares the history of one that has just been committed. */
void slc_wants_repeat(slc_manager *m, const struct slc_managed_texture *leader,
                      struct slc_managed_texture *t, uint64_t time, uint64_t timeout,
                      const struct slc_move_log *log);

/**
 * Finds which regular tiles a restored history wants, and counts them. The tiles are restored
 * apart. Scratch for the texture's work is reserved.
 */
void slc_wants_restore(slc_manager *m, struct slc_managed_texture *t);

/** A preparation came to nothing: gives back what it made. */
void slc_wants_abandon(slc_manager *m, struct slc_managed_texture *t);

/** As if nothing had ever been asked for: all wants go. */
void slc_wants_drop(slc_manager *m, struct slc_managed_texture *t);

#endif /* SLC_CORE_WANTS_H */
