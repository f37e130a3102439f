#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require

layout(constant_id = 0) const bool paged = false;
#include "sluice/shared/texture_table.h"
layout(std430, set = 0, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } table;
layout(std430, set = 0, binding = 1) readonly buffer MinMip { uint words[]; } minMip;
layout(std430, set = 0, binding = 2) buffer Feedback { uint words[]; } feedback;
layout(std430, set = 0, binding = 3) readonly buffer PageTable { uint words[]; } pageTable;
layout(set = 0, binding = 4) uniform sampler2DArray pages[64];
layout(set = 1, binding = 0) uniform sampler2D textures[];
#define SLUICE_TEXTURE_ENTRY(i) table.entries[i]
#define SLUICE_MIN_MIP_WORD(i) minMip.words[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#define SLUICE_PAGED paged
#define SLUICE_PAGE_TABLE_WORD(i) pageTable.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#define SLUICE_TEXTURE(i) textures[nonuniformEXT(i)]
#include "sluice/sample.glsl"
#include "sluice/feedback.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint tableIndex; /* of Sluice */
layout(location = 2) flat in uint imageIndex; /* in the engine's own array */
layout(location = 0) out vec4 color;

void main()
{
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    uint missing;
    color = sluiceSample(imageIndex, tableIndex, uv, 0.0, 8.0, missing);
    sluiceWriteFeedback(tableIndex, uv, dx, dy, 0.0, 8.0);
}
