/* Counts the requests of a group of sections, by key. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "requests.glsl"

layout(std430, binding = 4) buffer Scratch { uint words[]; } scratch;

uint countSections()
{
    uint count = 0u;
    for (uint i = 0u; i < SLUICE_SCAN_GROUP_SECTIONS; i++)
        count += totals[i] > 0u ? 1u : 0u;
    return count;
}

void main()
{
    uint at = gl_LocalInvocationIndex, scanGroup = sluiceScanGroup();
    uint sectionCount = scratch.words[SLUICE_SCAN_SECTION_COUNT];
    uint groups = sluiceScanGroups(sectionCount);
    if (scanGroup >= groups)
        return;
    uint index = scanGroup * SLUICE_SCAN_GROUP_SECTIONS + at / SLUICE_SCAN_PARTS;
    bool listed = index < sectionCount;
    uint entry = listed ? scratch.words[SLUICE_SCAN_LIST + index] : 0u;
    uint quad = sluicePartQuad(entry);
    uvec4 low = listed ? requests.quads[quad] : uvec4(0u);
    uvec4 high = listed ? requests.quads[quad + 1u] : uvec4(0u);
    sluiceShareCounts(entry, low, high);
    if (at < SLUICE_SCAN_KEYS)
        scratch.words[params.firstSum + at * groups + scanGroup] =
            sluiceCountKey(at, SLUICE_SCAN_GROUP_SECTIONS);
    else if (at == SLUICE_SCAN_KEYS)
        scratch.words[params.firstSum + at * groups + scanGroup] = countSections();
}
