/* Gives sluice/demand.glsl its bindings: this and notes.glsl, which only --needs wants, is all that
 * sampling on demand needs of a shader. */
#ifndef TRACER_TEXTURES_GLSL
#define TRACER_TEXTURES_GLSL

#include "sluice/shared/demand.h"
#include "../tracer_shared.h"

layout(constant_id = TRACER_CONSTANT_PREVIEW) const bool preview = false;

layout(std430, set = 0, binding = 0) readonly buffer DemandTextures
{
    SluiceDemandTexture demandTextures[];
};
layout(std430, set = 0, binding = 1) readonly buffer DemandLevels
{
    uint demandLevels[];
};
layout(std430, set = 0, binding = 2) readonly buffer DemandDirectory
{
    uint demandDirectory[];
};
layout(std430, set = 0, binding = 3) readonly buffer DemandBlocks
{
    uint demandBlocks[];
};
layout(std430, set = 0, binding = 4) buffer DemandMasks
{
    SluiceDemandBlockMasks demandMasks[];
};
layout(std430, set = 0, binding = 5) buffer DemandRequests
{
    uint demandRequests[];
};
layout(std430, set = 0, binding = 6) buffer DemandSections
{
    uint demandSections[];
};
layout(set = 0, binding = TRACER_BINDING_PAGES) uniform sampler2DArray pages[TRACER_PAGE_CHUNKS];

#include "notes.glsl"

#define SLUICE_DEMAND_TEXTURE(i) demandTextures[i]
#define SLUICE_DEMAND_LEVEL_WORD(i) demandLevels[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) demandDirectory[noteGroup(i)]
#define SLUICE_DEMAND_BLOCK_WORD(i) demandBlocks[notePage(i)]
#define SLUICE_DEMAND_MASKS(i) demandMasks[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) demandRequests[noteMiss(i)]
#define SLUICE_DEMAND_SECTION_WORD(i) demandSections[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#define SLUICE_DEMAND_PREVIEW preview

#include "sluice/demand.glsl"

#endif
