/* The lines that docs/demand.md shows, compiled as they are there. A shader that runs is demand.comp. */
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


layout(std430, binding = 7) buffer Answer { uvec2 values[]; } answer;
layout(push_constant) uniform Draw { uint index; uint firstPage; } draw;
layout(local_size_x = 8, local_size_y = 8) in;

void sampleTexture(uint index, vec2 uv, vec2 dx, vec2 dy)
{
    bool resident;
    vec4 color = sluiceDemandGrad(index, uv, dx, dy, resident);
    if (!resident)
        ; /* keep this pixel for the next launch; asking has been done */
    answer.values[0].x = packUnorm4x8(color);
}

void mapPage(uint firstPage, uint i)
{
    uvec2 value;
    if (sluiceMapOrRequest(firstPage + i, value))
        ; /* an address, an index, whatever pfnFill said */
    answer.values[1] = value;
}

void main()
{
    sampleTexture(draw.index, vec2(0.5), vec2(0.01, 0.0), vec2(0.0, 0.01));
    mapPage(draw.firstPage, gl_GlobalInvocationID.x);
}
