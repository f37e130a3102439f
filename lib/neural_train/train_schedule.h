/** What each step does: learning rates, and what is rounded. */
#ifndef SLC_NEURAL_TRAIN_SCHEDULE_H
#define SLC_NEURAL_TRAIN_SCHEDULE_H

#include "neural_train/train_plan.h"

/* What GLSL calls uint. */
typedef uint32_t slc_glsl_uint;
#define uint slc_glsl_uint
struct slc_train_push {
    TRAIN_PUSH_FIELDS
};
#undef uint

/** Steps for both networks. */
uint32_t slc_train_total_steps(const struct slc_train_plan *plan);

/** TRAIN_ flags of a step. */
uint32_t slc_train_flags(const struct slc_train_plan *plan, uint32_t step);

/** Fills in all but tilesPerGroup, groupCount and lossSlot. `step` may be UINT32_MAX: only
 * effective values for step 0 are made, and for UINT32_MAX below that. */
void slc_train_write_push(const struct slc_train_plan *plan, uint32_t step,
                          struct slc_train_push *push);

#endif /* SLC_NEURAL_TRAIN_SCHEDULE_H */
