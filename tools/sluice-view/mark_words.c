#include "mark_words.h"

#define AGE_SHIFT 16
#define AGE_STEP 62500u /* microseconds */
#define OLDEST 0xFFFFu
#define THRASH_BIT 16u

enum mark_reason mark_reason_of(SluiceCoarseReason reason)
{
    switch (reason) {
    case SLUICE_COARSE_ENOUGH: /* and the shader wants more */
    case SLUICE_COARSE_NOT_SEEN: return MARK_NOT_SEEN;
    case SLUICE_COARSE_HIDDEN:
    case SLUICE_COARSE_LIMIT:
    case SLUICE_COARSE_MIP_BIAS: return MARK_LIMIT;
    case SLUICE_COARSE_QUEUED:
    case SLUICE_COARSE_BANDWIDTH:
    case SLUICE_COARSE_READING:
    case SLUICE_COARSE_UPLOADING:
    case SLUICE_COARSE_FADING: return MARK_COMING;
    case SLUICE_COARSE_BUDGET: return MARK_BUDGET;
    case SLUICE_COARSE_FAILED: return MARK_FAILED;
    default: return MARK_NOTHING;
    }
}

uint32_t mark_word(enum mark_reason reason, bool thrashes, uint64_t age)
{
    const uint64_t steps = age / AGE_STEP;
    return (uint32_t)reason | (thrashes ? THRASH_BIT : 0u) |
           (uint32_t)(steps < OLDEST ? steps : OLDEST) << AGE_SHIFT;
}
