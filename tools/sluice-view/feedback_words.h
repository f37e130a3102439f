/** Who writes feedback, and how soon it is noticed. */
#ifndef SLUICE_VIEW_FEEDBACK_WORDS_H
#define SLUICE_VIEW_FEEDBACK_WORDS_H

#include "stage.h"

#define FEEDBACK_REGION 8u ///< pixels along a side of the region that predictions are for

struct feedback_outlook {
    bool known;    ///< false: no pixel writes
    double frames; ///< in which 99 of 100 regions are noticed
    double missed; ///< part of the regions in view that are evicted by mistake
};

/** Predicts by sluicePredictFeedbackDelay and sluicePredictFeedbackMiss. `texture_count`: textures
 *  that write feedback. */
struct feedback_outlook feedback_outlook_of(const struct view_settings *settings,
                                            uint32_t texture_count);
/** Textures whose maps are read: those that follow no other one. */
uint32_t feedback_texture_count(const struct stage *stage);
/** "one pixel in 8 x 8, each in 64 frames". Returns `text`. */
const char *feedback_writers(const struct view_settings *settings, uint32_t texture_count,
                             char *text, size_t size);

#endif /* SLUICE_VIEW_FEEDBACK_WORDS_H */
