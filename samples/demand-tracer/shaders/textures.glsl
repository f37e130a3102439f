/* Sampling on demand, with the library's descriptor set at 0. notes.glsl, for --needs only, records
 * the words that sampling reads. */
#ifndef TRACER_TEXTURES_GLSL
#define TRACER_TEXTURES_GLSL

#include "sluice/demand_bindings.glsl"
#include "../tracer_shared.h"

layout(constant_id = TRACER_CONSTANT_PREVIEW) const bool preview = false;
#define SLUICE_DEMAND_PREVIEW preview

#include "notes.glsl"

#undef SLUICE_DEMAND_DIRECTORY_WORD
#undef SLUICE_DEMAND_BLOCK_WORD
#undef SLUICE_DEMAND_REQUEST_WORD
#define SLUICE_DEMAND_DIRECTORY_WORD(i) sluiceDemandDirectoryWords[noteGroup(i)]
#define SLUICE_DEMAND_BLOCK_WORD(i) sluiceDemandBlockWords[notePage(i)]
#define SLUICE_DEMAND_REQUEST_WORD(i) sluiceDemandRequestWords[noteMiss(i)]

#include "sluice/demand.glsl"

#endif
