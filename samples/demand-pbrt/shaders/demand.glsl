/* Sampling on demand, with the descriptor set of a launch at 0. */
#ifndef PBRT_DEMAND_GLSL
#define PBRT_DEMAND_GLSL

#include "sluice/demand_bindings.glsl"
#include "../pbrt_shared.h"

layout(constant_id = PBRT_CONSTANT_PREVIEW) const bool preview = false;
#define SLUICE_DEMAND_PREVIEW preview

#include "sluice/demand.glsl"

#endif
