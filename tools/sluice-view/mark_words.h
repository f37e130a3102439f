/** Words of tiles for shaders: why finer levels are missing, and the age of the resident tile. */
#ifndef SLUICE_VIEW_MARK_WORDS_H
#define SLUICE_VIEW_MARK_WORDS_H

#include <sluice/vulkan_explain.h>

#include <stdbool.h>
#include <stdint.h>

/** Reasons by pattern. shaders/view_colors.glsl has the same values. */
enum mark_reason {
    MARK_NOTHING,
    MARK_COMING,   ///< queued, read, copied or fading in
    MARK_BUDGET,   ///< no memory
    MARK_FAILED,   ///< loading failed
    MARK_NOT_SEEN, ///< feedback has not requested a finer level yet
    MARK_LIMIT     ///< limited, biased or hidden by the application
};

enum mark_reason mark_reason_of(SluiceCoarseReason reason);
/** Returns the word of a level 0 tile. `age`: microseconds; UINT64_MAX: unknown. */
uint32_t mark_word(enum mark_reason reason, bool thrashes, uint64_t age);

#endif /* SLUICE_VIEW_MARK_WORDS_H */
