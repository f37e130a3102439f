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
#include "sluice/feedback_cube.glsl"
#include "sluice/sample_cube.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= params.count)
        return;
    uint at = params.first + gl_GlobalInvocationID.x;
    uint tableIndex = params.tableIndex;
    uint word = SLUICE_TEXTURE_ENTRY(tableIndex).feedbackOffset + gl_GlobalInvocationID.x;
    if ((params.flags & CUBE_CLEAR) != 0u) {
        SLUICE_FEEDBACK_WORD(word) = SLUICE_MIP_UNTOUCHED;
        return;
    }
    if ((params.flags & CUBE_WORDS) != 0u) {
        outputs[at].level = SLUICE_FEEDBACK_WORD(word);
        return;
    }
    vec3 direction = vec3(inputs[at].direction[0], inputs[at].direction[1], inputs[at].direction[2]);
    vec3 dx = vec3(inputs[at].dx[0], inputs[at].dx[1], inputs[at].dx[2]);
    vec3 dy = vec3(inputs[at].dy[0], inputs[at].dy[1], inputs[at].dy[2]);
    float bias = inputs[at].lodBias, anisotropy = inputs[at].maxAnisotropy;
    if ((params.flags & CUBE_SAMPLE) != 0u) {
        uint missing;
        vec4 color;
        color = sluiceSampleCubeGrad(CUBE_FORM, tableIndex, direction, dx, dy, bias, anisotropy, missing);
        for (uint i = 0u; i < 4u; i++)
            outputs[at].color[i] = color[i];
        outputs[at].missingLevels = missing;
        SluiceCubePoint p = sluiceFindCubePoint(direction, dx, dy);
        SluiceSampling s = sluiceResolveCube(tableIndex, p, bias, anisotropy);
        outputs[at].level = s.level;
        outputs[at].wantedLevel = s.wantedLevel;
        outputs[at].lod = s.lod;
    }
    if ((params.flags & CUBE_FEEDBACK) != 0u)
        sluiceWriteCubeFeedback(tableIndex, direction, dx, dy, bias, anisotropy);
    for (uint i = 0u; i < 4u && (params.flags & CUBE_FEEDBACK_QUAD) != 0u; i++)
        sluiceWriteCubeQuadFeedback(tableIndex, direction, dx, dy, bias, anisotropy,
                                    (at & 1u) != 0u ? uvec2(3u, 6u) : uvec2(i, i >> 1u),
                                    (at & 1u) != 0u ? i : 5u);
    if ((params.flags & CUBE_FEEDBACK_LOD) != 0u)
        sluiceWriteCubeFeedbackLod(tableIndex, direction, inputs[at].lod);
}
