/* Samples, writes feedback and checks residency at given places. Built with and without PROBE_CODES. */
#version 450
#ifndef PROBE_PAGE_LOOP
#extension GL_EXT_nonuniform_qualifier : require
#endif
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "probe_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 3) readonly buffer Inputs { ProbeInput inputs[]; };
layout(std430, binding = 4) buffer Outputs { ProbeOutput outputs[]; };
layout(binding = 5) uniform sampler2D tex;
layout(binding = 6) uniform sampler2D nearestMipTex;
layout(std430, set = 1, binding = 0) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 1, binding = 1) uniform sampler2DArray pages[PROBE_PAGE_CHUNKS];
layout(constant_id = 0) const bool paged = false;
layout(constant_id = 2) const bool mixed = false;
layout(constant_id = 1) const bool cubic = false;
layout(push_constant) uniform Push { ProbeParams params; };

#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#define SLUICE_PAGED paged
#define SLUICE_PAGED_PER_TEXTURE mixed
#define SLUICE_CUBIC cubic
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#ifdef PROBE_PAGE_LOOP
#define SLUICE_PAGE_TEXTURE(i) pages[i]
#define SLUICE_PAGE_LOOP PROBE_PAGE_CHUNKS
#else
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#endif
#include "probe_body.glsl"

void main()
{
    if (gl_GlobalInvocationID.x < params.count)
        probe(gl_GlobalInvocationID.x);
}
