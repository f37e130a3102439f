/** Plan of a file by the rules of other writers: sizes of grids, and grids of mips. */
#ifndef SLC_NEURAL_FILE_PLAN_H
#define SLC_NEURAL_FILE_PLAN_H

#include "neural/neural_set.h"

/**
 * Checks `info` except latents and weights. Fills `set` like a reader of the finished file, except
 * file, names, views and weights. Errors, logged: INVALID_ARGUMENT; not logged: NULL_POINTER.
 */
SluiceResult slc_neural_plan(const SluiceNeuralWriteInfo *info, struct SluiceNeuralSet *set);

#endif /* SLC_NEURAL_FILE_PLAN_H */
