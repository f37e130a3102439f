/* Texels of a set to sample, and what comes back, for C and GLSL. */
#ifndef NEURAL_PAGES_SHARED_H
#define NEURAL_PAGES_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

struct NeuralPageInput {
    int x, y;
    uint mip;
};
SLUICE_SHARED_SIZE(struct NeuralPageInput, 12)

struct NeuralPageOutput {
    uint resident, shown;
    float channels[16];
};
SLUICE_SHARED_SIZE(struct NeuralPageOutput, 72)

#endif /* NEURAL_PAGES_SHARED_H */
