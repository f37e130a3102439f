/* Writes the changes or the levels of one segment, and clears the feedback that it has reported. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "feedback.glsl"

layout(local_size_x = SLUICE_RESOLVE_GROUP_SIZE) in;
layout(std430, binding = 3) readonly buffer Scratch { uvec2 sums[]; } scratch;
layout(std430, binding = 4) writeonly buffer Readback { uint words[]; } readback;

shared uint changes[SLUICE_RESOLVE_SEGMENT_SIZE];

/* Neighbors write neighbors: words that go to the host one by one are as slow as lines of them. */
void writeChanges(SluiceQuad quad, uint region, uint to, uint count)
{
    uvec4 levels = sluiceUnpackLevels(quad.levels);
    bvec4 changed = sluiceChanged(quad);
    uint place = gl_LocalInvocationIndex, at = sluiceCountChangesBefore(place);
    for (uint i = 0u; i < 4u; i++)
        if (changed[i])
            changes[at++] = region + i << 8 | levels[i];
    barrier();
    for (uint i = place; i < count; i += SLUICE_RESOLVE_GROUP_SIZE)
        readback.words[to + i] = changes[i];
}

void clear(SluiceQuad quad)
{
    if (encoding == SLUICE_FEEDBACK_MASKS)
        feedbackMasks.quads[quad.index] = uvec2(0u);
    else
        feedbackLevels.quads[quad.index] = uvec4(SLUICE_MIP_UNTOUCHED);
}

void main()
{
    uint index = gl_WorkGroupID.y * SLUICE_RESOLVE_ROW + gl_WorkGroupID.x;
    if (index >= params.segmentCount)
        return;
    SluiceResolveSegment segment = sluiceResolveSegment(index);
    uvec2 item = scratch.sums[params.scratchItem + segment.item]; /* where, state */
    if (item.y == SLUICE_RESOLVED_NOTHING)
        return;
    uint place = gl_LocalInvocationIndex;
    uint first = scratch.sums[index].x, count = scratch.sums[index + 1u].x - first;
    SluiceQuad quad = sluiceLoadQuad(segment, place);
    if (item.y == SLUICE_RESOLVED_CHANGES && count > 0u) {
        sluiceShareChanges(quad);
        writeChanges(quad, segment.offset + place * 4u, params.dataOffset + item.x + first, count);
    }
    if (place * 4u >= segment.regionCount)
        return;
    if (item.y == SLUICE_RESOLVED_MAP)
        readback.words[params.dataOffset + item.x + segment.offset / 4u + place] = quad.levels;
    if (quad.levels != quad.before)
        last.quads[quad.index] = quad.levels;
    if (quad.levels != 0xFFFFFFFFu)
        clear(quad);
}
