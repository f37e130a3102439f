/* Bindings of the shaders that sample one layer twice: through a view of all layers and its own. */
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "probe_shared.h"

layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 3) readonly buffer Inputs { ProbeInput inputs[]; };
layout(std430, binding = 4) buffer Outputs { ProbeOutput outputs[]; };
layout(binding = 5) uniform sampler2DArray layersTex;
layout(binding = 6) uniform sampler2D layerTex;
layout(std430, set = 1, binding = 0) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 1, binding = 1) uniform sampler2DArray pages[PROBE_PAGE_CHUNKS];
layout(constant_id = 0) const bool paged = false;
layout(constant_id = 2) const bool mixed = false;
layout(push_constant) uniform Push { ProbeParams params; }; /* flags: the layer */

#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#ifndef ARRAY_UNPAGED
#define SLUICE_PAGED paged
#define SLUICE_PAGED_PER_TEXTURE mixed
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#endif
#include "sluice/feedback.glsl"
#include "sluice/sample_array.glsl"

void writeBoth(uint at, vec4 ofArray, uint missingOfArray, vec4 ofLayer, uint missingOfLayer)
{
    for (uint i = 0u; i < 4u; i++) {
        outputs[at].color[i] = ofArray[i];
        outputs[at].footprint[i] = floatBitsToUint(ofLayer[i]);
    }
    outputs[at].missingLevels = missingOfArray;
    outputs[at].wantedLevel = missingOfLayer;
}
