/*
 * One workgroup: counts become places, by key, then by group. Each invocation has a piece of the
 * counts, so that one prefix sum is enough. Writes the result.
 */
#include "prefix.glsl"
#include "scan.glsl"

shared uint requestCount;

uint sumPiece(uint first, uint end)
{
    uint sum = 0u;
    for (uint i = first; i < end; i++)
        sum += scratch.words[params.firstSum + i];
    return sum;
}

/** `sectionRow`: where the counts of sections begin, so that all before them are the requests. */
void placePiece(uint first, uint end, uint before, uint sectionRow)
{
    for (uint i = first; i < end; i++) {
        uint count = scratch.words[params.firstSum + i];
        scratch.words[params.firstSum + i] = before;
        if (i == sectionRow)
            requestCount = before;
        before += count;
    }
}

void sluicePlaceGroups()
{
    uint groups = sluiceScanGroups(scratch.words[SLUICE_SCAN_SECTION_COUNT]);
    uint count = groups * SLUICE_SCAN_SUMS, piece = (count + group - 1u) / group, total = 0u;
    if (gl_LocalInvocationIndex == 0u)
        requestCount = 0u;
    barrier();
    if (groups > 0u) {
        uint first = min(gl_LocalInvocationIndex * piece, count), end = min(first + piece, count);
        uint before = sluiceSumBefore(sumPiece(first, end), total);
        placePiece(first, end, before, groups * SLUICE_SCAN_KEYS);
        barrier();
    }
    /* together: each store by itself may be a transfer to the host */
    uint at = gl_LocalInvocationIndex, listed = min(requestCount, params.capacity);
    uvec4 result = uvec4(listed, requestCount, total - requestCount, requestCount - listed);
    if (at < 4u)
        readback.words[params.resultOffset + at] = result[at];
}
