/*
 * What the passes of a scan of requests share, see sluice/shared/demand_scan.h: compact.comp,
 * count.comp, place.comp, list.comp, in this order.
 */
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/demand_scan.h"

layout(push_constant) uniform Push { SluiceDemandScanParams params; };

uint sluiceScanGroups(uint sectionCount)
{
    return (sectionCount + SLUICE_SCAN_GROUP_SECTIONS - 1u) / SLUICE_SCAN_GROUP_SECTIONS;
}

uint sluiceScanSection(uint entry)
{
    return entry & (1u << SLUICE_SCAN_KEY_SHIFT) - 1u;
}
