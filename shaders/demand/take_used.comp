/* Brings the used bits of all blocks to the host, and clears them. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/demand_scan.h"

layout(local_size_x = SLUICE_PATCH_GROUP_SIZE) in;
layout(push_constant) uniform Push { SluiceDemandPatchParams params; };
layout(std430, binding = 0) buffer Masks { SluiceDemandBlockMasks blocks[]; } masks;
layout(std430, binding = 1) writeonly buffer Readback { uint words[]; } readback;

void main()
{
    uint row = gl_WorkGroupID.y * SLUICE_SCAN_ROW + gl_WorkGroupID.x;
    uint block = row * SLUICE_PATCH_GROUP_SIZE + gl_LocalInvocationIndex;
    if (block >= params.count)
        return;
    uint used = masks.blocks[block].used;
    readback.words[params.offset + block] = used;
    if (used != 0u)
        masks.blocks[block].used = 0u;
}
