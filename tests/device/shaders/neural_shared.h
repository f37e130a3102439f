/* Rectangles that neural.comp decodes, for C and GLSL. */
#ifndef NEURAL_SHARED_H
#define NEURAL_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

struct NeuralParams {
    uint set; /* number of the constants */
    uint mip;
    int x;
    int y;
    uint width;
    uint height;
    uint colorSpace; /* not 0: color space of all channels, which become linear */
};
SLUICE_SHARED_SIZE(struct NeuralParams, 28)

struct NeuralOutput {
    float channels[16];
    uint resident;
    uint size; /* size of the mip: width, height << 16 */
    uint mipCount;
    uint padding;
};
SLUICE_SHARED_SIZE(struct NeuralOutput, 80)

#endif
