/*
 * Buffers of the passes that scan requests: compact.glsl, count.glsl, place.glsl, list.glsl, in this
 * order (see sluice/shared/demand_scan.h). Each pass is a program, or whole.comp runs all passes in
 * one workgroup. Buffers are coherent for whole.comp.
 */
#ifndef SLUICE_DEMAND_SCAN_GLSL
#define SLUICE_DEMAND_SCAN_GLSL

#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/demand_scan.h"

layout(push_constant) uniform Push { SluiceDemandScanParams params; };
layout(std430, binding = 0) buffer Requests { uvec4 quads[]; } requests;
layout(std430, binding = 1) coherent buffer Sections { uint words[]; } sections;
layout(std430, binding = 2) coherent buffer Postponed { uint words[]; } postponed;
layout(std430, binding = 3) readonly buffer Ranks { uint words[]; } ranks;
layout(std430, binding = 4) coherent buffer Scratch { uint words[]; } scratch;
layout(std430, binding = 5) writeonly buffer Readback { uint words[]; } readback;

uint sluiceScanGroups(uint sectionCount)
{
    return (sectionCount + SLUICE_SCAN_GROUP_SECTIONS - 1u) / SLUICE_SCAN_GROUP_SECTIONS;
}

uint sluiceScanSection(uint entry)
{
    return entry & (1u << SLUICE_SCAN_KEY_SHIFT) - 1u;
}

#endif
