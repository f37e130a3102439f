/* Sums up samples of one tap that are jittered by random numbers on a grid. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "jitter_shared.h"

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
#include "sluice/feedback_jitter.glsl"
#include "sluice/sample.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= params.count)
        return;
    uint at = params.first + gl_GlobalInvocationID.x, kernel = params.flags & JITTER_KERNEL;
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]);
    vec2 dx = vec2(inputs[at].dx[0], inputs[at].dx[1]);
    vec2 dy = vec2(inputs[at].dy[0], inputs[at].dy[1]);
    float bias = inputs[at].lodBias, anisotropy = inputs[at].maxAnisotropy;
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(params.tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(params.tableIndex).sizeY);
    vec4 sum = vec4(0.0);
    uint worst = 0u;
    if ((params.flags & JITTER_OFFSETS) != 0u)
        sum.xy = sluiceJitterOffset(kernel, uv);
    if ((params.flags & JITTER_FEEDBACK) != 0u)
        sluiceWriteJitteredFeedback(params.tableIndex, uv, dx, dy, bias, anisotropy, kernel);
    int end = (params.flags & JITTER_SAMPLE) != 0u ? JITTER_GRID * JITTER_GRID : 0;
    for (int i = 0; i < end; i++) {
        uint missing;
        vec2 random = (vec2(i % JITTER_GRID, i / JITTER_GRID) + 0.5) / float(JITTER_GRID) - 0.5;
        vec2 moved = sluiceJitter(uv, dx, dy, bias, anisotropy, size, kernel, random);
        sum += sluiceSampleGrad(tex, params.tableIndex, moved, dx, dy, bias, anisotropy, missing) /
               float(end);
        worst = max(worst, missing);
    }
    for (uint c = 0u; c < 4u; c++)
        outputs[at].color[c] = sum[c];
    outputs[at].missingLevels = worst;
}
