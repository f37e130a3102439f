/* Sampling on demand, with the descriptor set of a launch at 0. Shaders that must not request
 * anything define PBRT_QUIET. */
#ifndef PBRT_DEMAND_GLSL
#define PBRT_DEMAND_GLSL

#include "sluice/demand_bindings.glsl"
#include "../pbrt_shared.h"

#ifdef PBRT_QUIET
/* All bits are set, as if everything had been requested before. */
layout(std430, set = 1, binding = PBRT_BINDING_QUIET) buffer Quiet
{
    uint quietWords[];
};
#undef SLUICE_DEMAND_REQUEST_WORD
#define SLUICE_DEMAND_REQUEST_WORD(i) quietWords[0]
#endif

#include "sluice/demand.glsl"

#endif
