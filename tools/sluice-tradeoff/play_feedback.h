/** What reaches the manager of the trace's maps: regions are left out at random, as stochastic
 *  feedback leaves them out, and maps may be read in turns. */
#ifndef SLUICE_TRADEOFF_PLAY_FEEDBACK_H
#define SLUICE_TRADEOFF_PLAY_FEEDBACK_H

#include "play_options.h"

#include <feedback_trace.h>

/** Zeroed is finished. */
struct play_feedback {
    const struct feedback_trace *trace;
    const struct play_options *options;
    uint8_t **maps;     ///< owned; per texture what is yet to be read, NULL before its first map
    bool *pending;      ///< owned; per texture
    uint32_t *order;    ///< owned; textures with a map, in the order of their first one
    uint32_t count;     ///< of `order`
    uint32_t turn;      ///< in `order`: whose turn is next
    uint32_t next, end; ///< of the frame's turns, counted from `turn` on
    uint64_t map_count; ///< of the trace, so far
};

/** False, with a message on stderr, if memory is short. */
bool play_feedback_init(struct play_feedback *feedback, const struct feedback_trace *trace,
                        const struct play_options *options);
void play_feedback_finish(struct play_feedback *feedback);

/** False, with a message, if memory is short. */
bool play_feedback_add(struct play_feedback *feedback, uint32_t texture, const uint8_t *map,
                       uint32_t frame);
/** After the frame's maps: those that are read in it are handed out by play_feedback_next. */
void play_feedback_begin_reading(struct play_feedback *feedback);
/** The next map; false if there are no more in this frame. It stays until the next frame. */
bool play_feedback_next(struct play_feedback *feedback, uint32_t *texture, const uint8_t **map);

/** The chance that a timeout's maps all miss a region that is always in view, as the library
 * predicts it; NaN where it says nothing: nothing is left out, or not every frame has every map. */
double play_feedback_predict_miss(const struct play_feedback *feedback, double frame_rate);

#endif /* SLUICE_TRADEOFF_PLAY_FEEDBACK_H */
