/** Program with which the shader samples a neural set: SPIR-V, and weights that fit it. */
#ifndef SAMPLES_STREAMING_NEURAL_PATH_H
#define SAMPLES_STREAMING_NEURAL_PATH_H

#include <sluice/neural.h>

#include "../../tools/common/gpu.h"
#include "settings.h"

struct neural_program {
    const uint32_t *words; ///< SPIR-V of neural.frag
    size_t words_size;     ///< bytes
    void *weights;         ///< owned
    uint64_t weight_size;
};

/** Chooses a program for a path. Reports on stderr why a path is not possible. */
bool neural_program_create(const struct gpu *gpu, const SluiceNeuralSet *set, enum neural_path path,
                           struct neural_program *program);
/** A zeroed struct is allowed. */
void neural_program_destroy(struct neural_program *program);

#endif /* SAMPLES_STREAMING_NEURAL_PATH_H */
