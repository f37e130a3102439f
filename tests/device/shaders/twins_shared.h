/* One call of a shader function that has a C twin, for C and GLSL. */
#ifndef TWINS_SHARED_H
#define TWINS_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define TWIN_HASH 0u
#define TWIN_SELECT_RANDOM_QUAD 1u
#define TWIN_SELECT_LATTICE 2u
#define TWIN_CLAMP_ANISOTROPY 3u
#define TWIN_CLAMP_LOD 4u
#define TWIN_CLAMP_LOD_BIAS 5u
#define TWIN_IS_FINITE 6u
#define TWIN_LOD_MARGIN 7u
#define TWIN_COMPUTE_LODS 8u
#define TWIN_COMPUTE_LOD 9u
#define TWIN_FINEST_LEVEL 10u
#define TWIN_COARSEST_LEVEL 11u
#define TWIN_LOD_LIMIT 12u
#define TWIN_SHOWN_LEVEL 13u
#define TWIN_SQUARE_LODS 14u
#define TWIN_FLOOR_LOG4 15u
#define TWIN_QUICK_LEVELS 16u
#define TWIN_SAFE_LEVELS 17u
#define TWIN_REGION_INDEX 18u
#define TWIN_REGION_RANGE 19u
#define TWIN_HALF_BOX 20u
#define TWIN_RANGE_STEP 21u
#define TWIN_NEXT_REGION 22u
#define TWIN_COMPUTE_FOOTPRINT 23u
#define TWIN_SELECT_BLOCK 24u
#define TWIN_COUNT 25u

#define TWIN_ARGUMENTS 16u
#define TWIN_RESULTS 8u

struct TwinCall {
    uint arguments[TWIN_ARGUMENTS]; /* numbers or the bits of floats */
    uint results[TWIN_RESULTS];
};
SLUICE_SHARED_SIZE(struct TwinCall, 96)

struct TwinParams {
    uint function;
    uint count;
};
SLUICE_SHARED_SIZE(struct TwinParams, 8)

#endif
