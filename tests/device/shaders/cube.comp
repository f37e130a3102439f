/* Samples cube maps and writes their feedback. Built for each form of the texture: CUBE_FORM. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "cube_shared.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool paged = false;
layout(constant_id = 2) const bool mixed = false;
layout(push_constant) uniform Push { ProbeParams params; };
#define SLUICE_PAGED paged
#define SLUICE_PAGED_PER_TEXTURE mixed
layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 3) readonly buffer Inputs { CubeInput inputs[]; };
layout(std430, binding = 4) buffer Outputs { ProbeOutput outputs[]; };
layout(binding = 5) uniform samplerCube cubeTex;
layout(binding = 6) uniform samplerCubeArray cubesTex;
layout(std430, set = 1, binding = 0) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 1, binding = 1) uniform sampler2DArray pages[PROBE_PAGE_CHUNKS];

#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#define SLUICE_CUBE_TEXTURE(i) cubeTex /* an array of one */
#ifdef CUBE_AS_ARRAY
#define CUBE_FORM cubesTex, params.flags >> CUBE_INDEX_SHIFT
#elif defined(CUBE_BY_NUMBER)
#define CUBE_FORM 0u
#else
#define CUBE_FORM cubeTex
#endif
#include "cube_body.glsl"

void main()
{
    if (gl_GlobalInvocationID.x < params.count)
        probeCube(gl_GlobalInvocationID.x);
}
