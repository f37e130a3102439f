/* Samples streamed textures by one texel that is chosen at random. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "stochastic_stream_shared.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool paged = false;
layout(push_constant) uniform Push { ProbeParams params; };
layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 3) readonly buffer Inputs { ProbeInput inputs[]; };
layout(std430, binding = 4) buffer Outputs { ProbeOutput outputs[]; };
layout(binding = 5) uniform sampler2D tex;
layout(std430, set = 1, binding = 0) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 1, binding = 1) uniform sampler2DArray pages[PROBE_PAGE_CHUNKS];

#define SLUICE_PAGED paged
#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#include "stochastic_stream_body.glsl"

void main()
{
    if (gl_GlobalInvocationID.x < params.count)
        sampleStochastic(gl_GlobalInvocationID.x);
}
