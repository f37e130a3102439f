/* Sampling on demand, with the descriptor set of a launch at 0. */
#ifndef PBRT_DEMAND_GLSL
#define PBRT_DEMAND_GLSL

#include "sluice/demand_bindings.glsl"
#include "scene.glsl"

#ifndef SLUICE_DEMAND_QUIET
#define SLUICE_DEMAND_QUIET ((launch.flags & PBRT_LAUNCH_QUIET) != 0u)
#endif

layout(constant_id = PBRT_CONSTANT_PREVIEW) const bool preview = false;
#define SLUICE_DEMAND_PREVIEW preview

#include "sluice/demand.glsl"

#endif
