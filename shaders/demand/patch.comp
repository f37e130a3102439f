/* Puts the words of the page table that changed in their places; none is named twice. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/demand_scan.h"

layout(local_size_x = SLUICE_PATCH_GROUP_SIZE) in;
layout(push_constant) uniform Push { SluiceDemandPatchParams params; };
layout(std430, binding = 0) writeonly buffer Directory { uint words[]; } directory;
layout(std430, binding = 1) writeonly buffer Blocks { uint words[]; } blocks;
layout(std430, binding = 2) writeonly buffer Masks { uint words[]; } masks;
layout(std430, binding = 3) readonly buffer Patches { uvec2 patches[]; } list;

void main()
{
    uint row = gl_WorkGroupID.y * SLUICE_SCAN_ROW + gl_WorkGroupID.x;
    uint index = row * SLUICE_PATCH_GROUP_SIZE + gl_LocalInvocationIndex;
    if (index >= params.count)
        return;
    uvec2 change = list.patches[index];
    uint word = change.x & (1u << SLUICE_PATCH_BUFFER_SHIFT) - 1u;
    switch (change.x >> SLUICE_PATCH_BUFFER_SHIFT) {
    case SLUICE_PATCH_DIRECTORY: directory.words[word] = change.y; break;
    case SLUICE_PATCH_BLOCKS: blocks.words[word] = change.y; break;
    default: masks.words[word] = change.y; break;
    }
}
