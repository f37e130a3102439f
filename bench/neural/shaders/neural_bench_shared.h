/* Parameters of the shaders of bench/neural, for C and GLSL. */
#ifndef NEURAL_BENCH_SHARED_H
#define NEURAL_BENCH_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define NEURAL_BENCH_MAX_WEIGHTS 17024 /* bytes of a uniform buffer */
#define NEURAL_BENCH_WEIGHT_ROOM 65536 /* bytes of a storage buffer */

struct NeuralBenchParams {
    uint width; /* width and height of the picture in pixels */
    uint height;
    uint frame;
    float lod;
    float uvPerPixel[2];
    uint textureSize[2];
};
SLUICE_SHARED_SIZE(struct NeuralBenchParams, 32)

#endif
