/*
 * One workgroup, as large as the device allows: counts of segments become places of segments, and
 * each item gets its place among the results or, where the room ends, none. Neighbors take
 * neighbors, all at once, then as many again.
 */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "resolve.glsl"

layout(local_size_x_id = 1) in;
/* In: count and checksum per segment. Out: their sums over all segments before, one element more;
 * and per item where its data begins and its state. */
layout(std430, binding = 3) coherent buffer Scratch { uvec2 sums[]; } scratch;
/* Whole results, because each store may be a transfer to the host. */
layout(std430, binding = 4) writeonly buffer Readback { uvec4 results[]; } readback;

const uint group = gl_WorkGroupSize.x;
shared uvec2 sums[2u * group]; /* two, in turns: one barrier per step */

/** The sum over all invocations before this one; `total`: over all. */
uvec2 sumBefore(uvec2 own, out uvec2 total)
{
    uint at = gl_LocalInvocationIndex, from = 0u;
    uvec2 sum = own;
    barrier(); /* for the call before */
    sums[at] = sum;
    for (uint step = 1u; step < group; step *= 2u) {
        barrier();
        sum += at >= step ? sums[from + at - step] : uvec2(0u);
        from = group - from;
        sums[from + at] = sum;
    }
    barrier();
    total = sums[from + group - 1u];
    return sum - own;
}

void scanSegments()
{
    uvec2 carry = uvec2(0u), total;
    for (uint first = 0u; first < params.segmentCount; first += group) {
        uint i = first + gl_LocalInvocationIndex;
        bool inside = i < params.segmentCount;
        uvec2 before = sumBefore(inside ? scratch.sums[i] : uvec2(0u), total);
        if (inside)
            scratch.sums[i] = carry + before;
        carry += total;
    }
    if (gl_LocalInvocationIndex == 0u)
        scratch.sums[params.segmentCount] = carry;
}

/** Changes, or the whole map where that is smaller or asked for. `count`: words. */
SluiceResolveResult measure(uint index, out uint firstChange)
{
    SluiceResolveItem item = sluiceResolveItem(index);
    uvec2 first = scratch.sums[item.firstSegment];
    uvec2 sum = scratch.sums[item.firstSegment + item.segmentCount] - first;
    uint mapSize = (item.regionCount + 3u) / 4u;
    bool whole = (item.flags & SLUICE_RESOLVE_WHOLE) != 0u || sum.x > mapSize ||
                 (sum.x > 0u && item.regionCount > SLUICE_RESOLVE_MAX_LISTED_REGIONS);
    firstChange = first.x;
    return SluiceResolveResult(whole ? SLUICE_RESOLVED_MAP : SLUICE_RESOLVED_CHANGES,
                               whole ? mapSize : sum.x, 0u, sum.y);
}

/** `at`: words of all items before. */
void placeItem(uint index, SluiceResolveResult result, uint firstChange, uint at)
{
    result.offset = result.count > 0u ? at : 0u;
    if (result.count > 0u && at + result.count > params.capacity)
        result = SluiceResolveResult(SLUICE_RESOLVED_NOTHING, 0u, 0u, 0u);
    readback.results[params.resultOffset / 4u + index] =
        uvec4(result.state, result.count, result.offset, result.checksum);
    /* so that write.comp only has to add a segment's place to it */
    uint base = result.state == SLUICE_RESOLVED_CHANGES ? result.offset - firstChange : result.offset;
    scratch.sums[params.scratchItem + index] = uvec2(base, result.state);
}

void placeItems()
{
    uvec2 carry = uvec2(0u), total;
    for (uint first = 0u; first < params.itemCount; first += group) {
        uint i = first + gl_LocalInvocationIndex, firstChange = 0u;
        bool inside = i < params.itemCount;
        SluiceResolveResult result = SluiceResolveResult(0u, 0u, 0u, 0u);
        if (inside)
            result = measure(i, firstChange);
        uvec2 before = sumBefore(uvec2(result.count, 0u), total);
        if (inside)
            placeItem(i, result, firstChange, carry.x + before.x);
        carry += total;
    }
}

void main()
{
    scanSegments();
    memoryBarrierBuffer();
    barrier();
    placeItems();
}
