/* Samples a streamed texture and asks for what is seen of it: one source for all residency modes. */
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require

#include "sluice/shared/texture_table.h"

layout(std430, set = 0, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, set = 0, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, set = 0, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, set = 0, binding = 3) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 0, binding = 4) uniform sampler2DArray pages[8]; /* PAGE_CHUNKS in vulkan_drawing.h */
layout(constant_id = 0) const bool paged = false;
#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#define SLUICE_PAGED paged
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#include "sluice/feedback.glsl"
#include "sluice/sample.glsl"
#include "sluice/stochastic.glsl"

layout(set = 1, binding = 0) uniform sampler2D albedo;
layout(push_constant) uniform Draw { uint surface, tableIndex, frame; float aspect, eyeZ; } draw;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

void main()
{
    vec2 dx = dFdx(uv), dy = dFdy(uv); /* before the branch: they need all of the quad */
    uint missing;
    color = sluiceSample(albedo, draw.tableIndex, uv, 0.0, 1.0, missing);
    if (sluiceSelectFragmentLattice(gl_FragCoord.xy, draw.frame))
        sluiceWriteFeedback(draw.tableIndex, uv, dx, dy, 0.0, 1.0);
}
