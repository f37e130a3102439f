/* Samples 256 x 256 places of four textures, at full detail, and counts what is missing. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/demand.h"

layout(std430, binding = 0) readonly buffer Textures { SluiceDemandTexture entries[]; } textures;
layout(std430, binding = 1) readonly buffer Levels { uint words[]; } levels;
layout(std430, binding = 2) readonly buffer Directory { uint words[]; } directory;
layout(std430, binding = 3) readonly buffer Blocks { uint words[]; } blocks;
layout(std430, binding = 4) buffer Masks { SluiceDemandBlockMasks entries[]; } masks;
layout(std430, binding = 5) buffer Requests { uint words[]; } requests;
layout(std430, binding = 6) buffer Sections { uint words[]; } sections;
layout(binding = 8) uniform sampler2DArray pages[64];
#define SLUICE_DEMAND_TEXTURE(i) textures.entries[i]
#define SLUICE_DEMAND_LEVEL_WORD(i) levels.words[i]
#define SLUICE_DEMAND_DIRECTORY_WORD(i) directory.words[i]
#define SLUICE_DEMAND_BLOCK_WORD(i) blocks.words[i]
#define SLUICE_DEMAND_MASKS(i) masks.entries[i]
#define SLUICE_DEMAND_REQUEST_WORD(i) requests.words[i]
#define SLUICE_DEMAND_SECTION_WORD(i) sections.words[i]
#define SLUICE_PAGE_TEXTURE(i) pages[nonuniformEXT(i)]
#include "sluice/demand.glsl"

layout(std430, binding = 7) buffer Answer { uint missing; vec4 color; uint indices[4]; } answer;
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    uint index = answer.indices[(at.x / 8u + at.y / 8u) % 4u];
    vec2 uv = vec2(0.25, 0.75) + vec2(at) / 8192.0;
    vec2 dx = vec2(1.0 / 8192.0, 0.0), dy = dx.yx; /* one pixel is one texel */
    bool resident;
    vec4 color = sluiceDemandGrad(index, uv, dx, dy, resident);
    if (!resident)
        atomicAdd(answer.missing, 1u);
    if (at == uvec2(0u))
        answer.color = color;
}
