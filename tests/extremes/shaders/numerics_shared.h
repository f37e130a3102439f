/* A call of a shader function whose exact result is known, for C and GLSL. */
#ifndef NUMERICS_SHARED_H
#define NUMERICS_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define NUMERICS_LODS 0u
#define NUMERICS_QUICK_LEVELS 1u
#define NUMERICS_SAFE_LEVELS 2u
#define NUMERICS_FLOOR_LOG4 3u
#define NUMERICS_ENDS 4u
#define NUMERICS_SHOWN 5u
#define NUMERICS_CLAMPS 6u
#define NUMERICS_HALF_BOX 7u
#define NUMERICS_LOD_COUNT 8u

#define NUMERICS_REGION_RANGE 8u
#define NUMERICS_QUICK_REGION 9u
#define NUMERICS_SELECT_RANDOM 10u
#define NUMERICS_SELECT_LATTICE 11u
#define NUMERICS_REGION_COUNT 4u

#define NUMERICS_FOLD 12u
#define NUMERICS_PAGE_AXIS 13u
#define NUMERICS_TAPS 14u
#define NUMERICS_SPLINE 15u
#define NUMERICS_DEMAND_LOD 16u
#define NUMERICS_WIDEN 17u
#define NUMERICS_PAGE_COUNT 6u

#define NUMERICS_COUNT 18u

#define NUMERICS_ARGUMENTS 10u
#define NUMERICS_RESULTS 6u

struct NumericsCall {
    uint arguments[NUMERICS_ARGUMENTS]; /* numbers or the bits of floats */
    uint results[NUMERICS_RESULTS];
};
SLUICE_SHARED_SIZE(struct NumericsCall, 64)

struct NumericsParams {
    uint function;
    uint count;
};
SLUICE_SHARED_SIZE(struct NumericsParams, 8)

#endif
