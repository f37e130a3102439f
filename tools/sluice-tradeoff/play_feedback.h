/** Simulates the feedback that reaches the manager. Leaves out regions of the trace's maps at
 * random, as stochastic feedback does. Maps may be read in turns. */
#ifndef SLUICE_TRADEOFF_PLAY_FEEDBACK_H
#define SLUICE_TRADEOFF_PLAY_FEEDBACK_H

#include "play_options.h"

#include <feedback_trace.h>

/** Zeroed is finished. */
struct play_feedback {
    const struct feedback_trace *trace;
    const struct play_options *options;
    uint8_t **maps;     ///< owned; by texture: unread feedback; NULL before its first map
    bool *pending;      ///< owned; by texture: true: has unread feedback
    uint32_t *order;    ///< owned; textures with a map, in the order of their first map
    uint32_t count;     ///< length of `order`
    uint32_t turn;      ///< index in `order` of the next texture to read
    uint32_t next, end; ///< turns of this frame: next and end, counted from `turn`
    uint64_t map_count; ///< maps of the trace so far
};

/** Returns false when out of memory, with a message on stderr. */
bool play_feedback_init(struct play_feedback *feedback, const struct feedback_trace *trace,
                        const struct play_options *options);
void play_feedback_finish(struct play_feedback *feedback);

/** Adds a map of the trace. Returns false when out of memory, with a message on stderr. */
bool play_feedback_add(struct play_feedback *feedback, uint32_t texture, const uint8_t *map,
                       uint32_t frame);
/** Selects the maps to read in this frame. Call after the frame's maps were added. */
void play_feedback_begin_reading(struct play_feedback *feedback);
/** Returns the next map to read, or false if the frame has no more. The map is valid until the next
 * frame. */
bool play_feedback_next(struct play_feedback *feedback, uint32_t *texture, const uint8_t **map);

/** Returns the library's prediction: the chance that all maps within a timeout miss a region that
 * is always visible. NaN without prediction: no region is left out, or not every frame has every
 * map. */
double play_feedback_predict_miss(const struct play_feedback *feedback, double frame_rate);

#endif /* SLUICE_TRADEOFF_PLAY_FEEDBACK_H */
