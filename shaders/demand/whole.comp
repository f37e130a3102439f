/*
 * All passes of a scan in one workgroup, and so without waiting for the device between them: less
 * time where few sections are flagged, or none.
 */
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/demand_scan.h"

layout(local_size_x = SLUICE_SCAN_GROUP_SIZE) in;

#include "compact.glsl"
#include "count.glsl"
#include "list.glsl"
#include "place.glsl"

void endPass()
{
    memoryBarrierBuffer();
    barrier();
}

void main()
{
    sluiceCompactSections();
    endPass();
    uint sectionCount = scratch.words[SLUICE_SCAN_SECTION_COUNT];
    uint groups = sluiceScanGroups(sectionCount);
    for (uint i = 0u; i < groups; i++)
        sluiceCountGroup(i, sectionCount, groups);
    endPass();
    sluicePlaceGroups();
    endPass();
    for (uint i = 0u; i < groups; i++)
        sluiceListGroup(i, sectionCount, groups);
}
