/*
 * Buffers and functions of the passes of a resolve. count.comp counts the changes of each segment.
 * scan.comp turns the counts into places. write.comp writes the changes and clears reported feedback.
 * Places come from prefix sums, not from an atomic counter, so equal feedback gives equal lists.
 */
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/resolve.h"
#include "sluice/shared/texture_table.h"

layout(constant_id = 0) const uint encoding = SLUICE_FEEDBACK_LEVELS;

layout(push_constant) uniform Push { SluiceResolveParams params; };
layout(std430, binding = 2) readonly buffer Table { uvec4 records[]; } table;

SluiceResolveSegment sluiceResolveSegment(uint index)
{
    uvec4 r = table.records[params.firstSegment + index];
    return SluiceResolveSegment(r.x, r.y, r.z, r.w);
}

SluiceResolveItem sluiceResolveItem(uint index)
{
    uvec4 r = table.records[params.firstItem + index];
    return SluiceResolveItem(r.x, r.y, r.z, r.w);
}

uint sluicePackLevels(uvec4 levels)
{
    levels = min(levels, uvec4(SLUICE_MIP_UNTOUCHED));
    return levels.x | levels.y << 8 | levels.z << 16 | levels.w << 24;
}

uvec4 sluiceUnpackLevels(uint packedLevels)
{
    return uvec4(packedLevels, packedLevels >> 8, packedLevels >> 16, packedLevels >> 24) & 255u;
}

/** Untouched where no bit is set. */
uvec4 sluiceMaskLevels(uvec2 masks)
{
    ivec4 lowest = findLSB(uvec4(masks.x & 0xFFFFu, masks.x >> 16, masks.y & 0xFFFFu, masks.y >> 16));
    return min(uvec4(lowest), uvec4(SLUICE_MIP_UNTOUCHED)); /* -1 is the largest of all */
}

/**
 * A map's checksum is the sum over its regions of weight * (255 - level), modulo 2^32. Weights are
 * odd, so that no single wrong level goes unnoticed; an untouched map has 0. C twin:
 * slc_resolve_weight.
 */
uint sluiceResolveWeight(uint region)
{
    uint x = region * 0x9E3779B1u;
    x = (x ^ x >> 15) * 0x85EBCA77u;
    return x ^ x >> 13 | 1u;
}
