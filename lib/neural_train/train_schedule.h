/** Schedule of steps: learning rates and rounding. */
#ifndef SLC_NEURAL_TRAIN_SCHEDULE_H
#define SLC_NEURAL_TRAIN_SCHEDULE_H

#include "neural_train/train_plan.h"

/* GLSL's uint. */
typedef uint32_t slc_glsl_uint;
#define uint slc_glsl_uint
struct slc_train_push {
    TRAIN_PUSH_FIELDS
};
#undef uint

/** Returns the number of steps for both networks. */
uint32_t slc_train_total_steps(const struct slc_train_plan *plan);

/** Returns the TRAIN_ flags of a step. */
uint32_t slc_train_flags(const struct slc_train_plan *plan, uint32_t step);

/** Fills all fields except tilesPerGroup, groupCount and lossSlot. `step` UINT32_MAX: only
 * effective values for step 0 are made. */
void slc_train_write_push(const struct slc_train_plan *plan, uint32_t step,
                          struct slc_train_push *push);

#endif /* SLC_NEURAL_TRAIN_SCHEDULE_H */
