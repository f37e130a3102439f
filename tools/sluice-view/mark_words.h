/** Words of tiles that shaders show: why no finer level is there, and how old what is there is. */
#ifndef SLUICE_VIEW_MARK_WORDS_H
#define SLUICE_VIEW_MARK_WORDS_H

#include <sluice/vulkan_explain.h>

#include <stdbool.h>
#include <stdint.h>

/** Reasons by pattern, as shaders/view_colors.glsl has them. */
enum mark_reason {
    MARK_NOTHING,
    MARK_COMING,   ///< queued, read, copied or fading in
    MARK_BUDGET,   ///< no memory
    MARK_FAILED,   ///< loading failed
    MARK_NOT_SEEN, ///< feedback has requested no more so far
    MARK_LIMIT     ///< limits, biases and hiding by the application
};

enum mark_reason mark_reason_of(SluiceCoarseReason reason);
/** Word of a tile of level 0. `age`: microseconds; UINT64_MAX: unknown. */
uint32_t mark_word(enum mark_reason reason, bool thrashes, uint64_t age);

#endif /* SLUICE_VIEW_MARK_WORDS_H */
