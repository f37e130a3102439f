#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
layout(std430, set = 1, binding = 0) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 1, binding = 1) uniform sampler2DArray pages[64]; // maxPageChunkCount
#define SLUICE_PAGED true
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#include "sluice/shared/texture_table.h"
layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, binding = 2) buffer Feedback { uint words[]; } feedback;
#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#include "sluice/sample.glsl"
#include "sluice/feedback.glsl"
#include "sluice/stochastic.glsl"

layout(set = 1, binding = 2) uniform sampler2D albedo;
layout(push_constant) uniform Draw { uint tableIndex; uint frameSeed; } draw;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;

void main()
{
    uint tableIndex = draw.tableIndex, frameSeed = draw.frameSeed;
    /* 0.0 is the LOD bias, 8.0 the sampler's maxAnisotropy (1.0: none) */
    uint missing;
    vec4 color = sluiceSample(albedo, tableIndex, uv, 0.0, 8.0, missing);
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    if (sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, frameSeed, 1.0 / 16.0))
        sluiceWriteQuadFeedback(tableIndex, uv, dx, dy, 0.0, 8.0, uvec2(gl_FragCoord.xy), frameSeed);
    result = color;
}
