/* Counts the requests of a group of sections, by key. */
#include "requests.glsl"

/* In whatever order they are added up: it is a sum. The last one is of sections. */
shared uint keySums[SLUICE_SCAN_SUMS];

void sumKeys(uint section)
{
    if (totals[section] == 0u)
        return;
    atomicAdd(keySums[entries[section] >> SLUICE_SCAN_KEY_SHIFT], totals[section]);
    atomicAdd(keySums[SLUICE_SCAN_KEYS], 1u);
}

void sluiceCountGroup(uint scanGroup, uint sectionCount, uint groups)
{
    uint at = gl_LocalInvocationIndex;
    if (at < SLUICE_SCAN_SUMS)
        keySums[at] = 0u;
    uint index = scanGroup * SLUICE_SCAN_GROUP_SECTIONS + at / SLUICE_SCAN_PARTS;
    bool listed = index < sectionCount;
    uint entry = listed ? scratch.words[SLUICE_SCAN_LIST + index] : 0u;
    uint quad = sluicePartQuad(entry);
    uvec4 low = listed ? requests.quads[quad] : uvec4(0u);
    uvec4 high = listed ? requests.quads[quad + 1u] : uvec4(0u);
    sluiceShareCounts(entry, low, high);
    if (at < SLUICE_SCAN_GROUP_SECTIONS)
        sumKeys(at);
    barrier();
    if (at < SLUICE_SCAN_SUMS)
        scratch.words[params.firstSum + at * groups + scanGroup] = keySums[at];
    barrier(); /* the next group may begin */
}
