/* Counts the changes of one segment, and sums up its checksum. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "feedback.glsl"

layout(local_size_x = SLUICE_RESOLVE_GROUP_SIZE) in;
layout(std430, binding = 3) writeonly buffer Scratch { uvec2 sums[]; } scratch;

shared uvec2 sums[SLUICE_RESOLVE_GROUP_SIZE];

uint checksum(SluiceResolveSegment segment, uint place, uint packedLevels)
{
    uvec4 levels = sluiceUnpackLevels(packedLevels);
    uint sum = 0u;
    for (uint i = 0u; i < 4u; i++)
        if (place * 4u + i < segment.regionCount)
            sum += sluiceResolveWeight(segment.offset + place * 4u + i) *
                   (SLUICE_MIP_UNTOUCHED - levels[i]);
    return sum;
}

void main()
{
    uint index = gl_WorkGroupID.y * SLUICE_RESOLVE_ROW + gl_WorkGroupID.x;
    if (index >= params.segmentCount)
        return;
    uint place = gl_LocalInvocationIndex;
    SluiceResolveSegment segment = sluiceResolveSegment(index);
    SluiceQuad quad = sluiceLoadQuad(segment, place);
    sums[place] = uvec2(sluiceCountChanges(quad), checksum(segment, place, quad.levels));
    for (uint step = SLUICE_RESOLVE_GROUP_SIZE / 2u; step > 0u; step /= 2u) {
        barrier();
        if (place < step)
            sums[place] += sums[place + step];
    }
    if (place == 0u)
        scratch.sums[index] = sums[0];
}
