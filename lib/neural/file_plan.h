/** Plans a file by the rules of its writers: sizes of grids, and which mips use them. */
#ifndef SLC_NEURAL_FILE_PLAN_H
#define SLC_NEURAL_FILE_PLAN_H

#include "neural/neural_set.h"

/**
 * Checks everything of `info` but latents and weights, and fills `set` as reading the file would,
 * without file, names, views and weights. Errors, logged: INVALID_ARGUMENT; not logged:
 * NULL_POINTER.
 */
SluiceResult slc_neural_plan(const SluiceNeuralWriteInfo *info, struct SluiceNeuralSet *set);

#endif /* SLC_NEURAL_FILE_PLAN_H */
