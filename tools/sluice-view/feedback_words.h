/** Pixels that write feedback, and predictions of how soon feedback notices a region. */
#ifndef SLUICE_VIEW_FEEDBACK_WORDS_H
#define SLUICE_VIEW_FEEDBACK_WORDS_H

#include "stage.h"

#define FEEDBACK_REGION 8u ///< pixels per side of the region that predictions assume

struct feedback_outlook {
    bool known;    ///< false: no pixel writes feedback
    double frames; ///< frames until 99 of 100 regions are noticed
    double missed; ///< part of the visible regions that is evicted by mistake, 0 to 1
};

/** Predicts by sluicePredictFeedbackDelay and sluicePredictFeedbackMiss. `texture_count`: textures
 *  that write feedback. */
struct feedback_outlook feedback_outlook_of(const struct view_settings *settings,
                                            uint32_t texture_count);
/** Number of textures whose maps are read: textures without a primary. */
uint32_t feedback_texture_count(const struct stage *stage);
/** Describes the pixels that write: "one pixel in 8 x 8, each in 64 frames". Returns `text`. */
const char *feedback_writers(const struct view_settings *settings, uint32_t texture_count,
                             char *text, size_t size);

#endif /* SLUICE_VIEW_FEEDBACK_WORDS_H */
