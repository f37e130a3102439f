/* Counts the changes of one segment, and sums up its checksum. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "feedback.glsl"

layout(local_size_x = SLUICE_RESOLVE_GROUP_SIZE) in;
layout(std430, binding = 3) writeonly buffer Scratch { uvec2 sums[]; } scratch;

shared uint sum;

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
    if (place == 0u)
        sum = 0u;
    sluiceShareChanges(quad);
    atomicAdd(sum, checksum(segment, place, quad.levels)); /* in whatever order: it is modulo 2^32 */
    barrier();
    if (place == 0u)
        scratch.sums[index] = uvec2(sluiceCountChangesBefore(SLUICE_RESOLVE_GROUP_SIZE), sum);
}
