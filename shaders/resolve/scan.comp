/*
 * One workgroup: counts of segments become places of segments, and each item gets its place among
 * the results or, where the room ends, none. Each invocation takes a run of neighbours.
 */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "resolve.glsl"

#define GROUP SLUICE_RESOLVE_SCAN_GROUP_SIZE

layout(local_size_x = GROUP) in;
/* In: count and checksum per segment. Out: their sums over all segments before, one element more;
 * and per item where its data begins and its state. */
layout(std430, binding = 3) coherent buffer Scratch { uvec2 sums[]; } scratch;
/* Whole results, because each store may be a transfer to the host. */
layout(std430, binding = 4) writeonly buffer Readback { uvec4 results[]; } readback;

shared uvec2 sums[GROUP];

/** The sum over all invocations before this one. */
uvec2 sumBefore(uvec2 own)
{
    uint at = gl_LocalInvocationIndex;
    barrier(); /* for the call before */
    sums[at] = own;
    uvec2 sum = own;
    for (uint step = 1u; step < GROUP; step *= 2u) {
        barrier();
        uvec2 left = at >= step ? sums[at - step] : uvec2(0u);
        barrier();
        sum += left;
        sums[at] = sum;
    }
    return sum - own;
}

/** This invocation's run of `count` elements: first and end. */
uvec2 ownRun(uint count)
{
    uint size = (count + GROUP - 1u) / GROUP;
    return min(uvec2(gl_LocalInvocationIndex, gl_LocalInvocationIndex + 1u) * size, uvec2(count));
}

void scanSegments()
{
    uvec2 run = ownRun(params.segmentCount);
    uvec2 sum = uvec2(0u);
    for (uint i = run.x; i < run.y; i++)
        sum += scratch.sums[i];
    sum = sumBefore(sum);
    for (uint i = run.x; i < run.y; i++) {
        uvec2 own = scratch.sums[i];
        scratch.sums[i] = sum;
        sum += own;
    }
    if (gl_LocalInvocationIndex == GROUP - 1u)
        scratch.sums[params.segmentCount] = sum;
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

void placeItems()
{
    uvec2 run = ownRun(params.itemCount);
    uint firstChange, size = 0u;
    for (uint i = run.x; i < run.y; i++)
        size += measure(i, firstChange).count;
    uint at = sumBefore(uvec2(size, 0u)).x;
    for (uint i = run.x; i < run.y; i++) {
        SluiceResolveResult result = measure(i, firstChange);
        result.offset = result.count > 0u ? at : 0u;
        at += result.count;
        if (result.count > 0u && at > params.capacity)
            result = SluiceResolveResult(SLUICE_RESOLVED_NOTHING, 0u, 0u, 0u);
        readback.results[params.resultOffset / 4u + i] =
            uvec4(result.state, result.count, result.offset, result.checksum);
        /* so that write.comp only has to add a segment's place to it */
        uint base = result.state == SLUICE_RESOLVED_CHANGES ? result.offset - firstChange : result.offset;
        scratch.sums[params.scratchItem + i] = uvec2(base, result.state);
    }
}

void main()
{
    scanSegments();
    memoryBarrierBuffer();
    barrier();
    placeItems();
}
