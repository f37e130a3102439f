/* Looks pages up, and marks resident ones as used. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/demand.h"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint count; };
layout(std430, binding = 0) readonly buffer Directory { uint blocks[]; } directory;
layout(std430, binding = 1) buffer Masks { SluiceDemandBlockMasks blocks[]; } masks;
layout(std430, binding = 2) readonly buffer Pages { uint pages[]; } list;

void main()
{
    if (gl_GlobalInvocationID.x >= count)
        return;
    uint page = list.pages[gl_GlobalInvocationID.x], bit = 1u << page % SLUICE_DEMAND_BLOCK_PAGES;
    uint block = directory.blocks[page / SLUICE_DEMAND_BLOCK_PAGES];
    if (block != SLUICE_DEMAND_NO_BLOCK && (masks.blocks[block].resident & bit) != 0u)
        atomicOr(masks.blocks[block].used, bit);
}
