/* Calls of stochastic_filter.glsl, for C and GLSL. */
#ifndef STOCHASTIC_SHARED_H
#define STOCHASTIC_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

struct StochasticCall {
    float uv[2];
    float lod;
    float sigma;
    float random[2]; /* numbers of all draws, without grid or seed */
    uint width;
    uint height;
    uint levelCount;
    uint modeU;
    uint modeV;
    uint kernel;
    uint seed; /* seed of hashed draws; 0: see grid */
    uint grid; /* draws are the middles of this many cells of one number; 0: random */
    uint axis; /* number that the grid covers; the other one is random */
    uint padding;
};
SLUICE_SHARED_SIZE(struct StochasticCall, 64)

struct StochasticPick {
    int texel[2];
    uint level;
    uint border;
    float random[2]; /* numbers for reuse */
};
SLUICE_SHARED_SIZE(struct StochasticPick, 24)

#endif
