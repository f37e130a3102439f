/* Tiles that a sampler touched: a bit each, for C and GLSL. */
#ifndef TRUTH_SHARED_H
#define TRUTH_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define TRUTH_WORDS 4u /* words of bits per sample */

struct TruthParams {
    uint count;
    uint layerCount;
};
SLUICE_SHARED_SIZE(struct TruthParams, 8)

#endif
