/* The second pass of a scan of requests. */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/demand_scan.h"

layout(local_size_x = SLUICE_SCAN_GROUP_SIZE) in;

#include "count.glsl"

void main()
{
    uint sectionCount = scratch.words[SLUICE_SCAN_SECTION_COUNT];
    uint groups = sluiceScanGroups(sectionCount);
    for (uint i = gl_WorkGroupID.x; i < groups; i += gl_NumWorkGroups.x)
        sluiceCountGroup(i, sectionCount, groups);
}
