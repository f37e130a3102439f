/*
 * One workgroup: lists the sections that are flagged, by id, each with its key, and clears the flags.
 * Whoever finds that bits stay sets them again.
 */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scan.glsl"

layout(local_size_x_id = 0) in;
layout(std430, binding = 1) buffer Sections { uvec4 quads[]; } sections;
layout(std430, binding = 2) buffer Postponed { uvec4 quads[]; } postponed;
layout(std430, binding = 3) readonly buffer Ranks { uint words[]; } ranks;
layout(std430, binding = 4) writeonly buffer Scratch { uint words[]; } scratch;

#include "prefix.glsl"

shared uint found; /* 1 + the last round with any flag */

/** Bits of the four words that are sections below the end. */
uvec4 validBits(uint quad)
{
    ivec4 left = ivec4(int(params.sectionEnd)) - ivec4(int(quad) * 128) - ivec4(0, 32, 64, 96);
    uvec4 some = (uvec4(1u) << uvec4(clamp(left, 0, 31))) - 1u;
    return mix(some, uvec4(0xFFFFFFFFu), greaterThanEqual(left, ivec4(32)));
}

bool anyFlag(uint round, uvec4 flags)
{
    if (any(notEqual(flags, uvec4(0u))))
        atomicMax(found, round + 1u);
    barrier();
    bool there = found == round + 1u;
    barrier(); /* the next round may begin */
    return there;
}

uint keyOf(uint section, bool old)
{
    uint rank = ranks.words[section / 4u] >> 8u * (section % 4u) & SLUICE_DEMAND_RANKS - 1u;
    return old ? rank : rank + SLUICE_DEMAND_RANKS;
}

void listFlags(uint first, uint flags, uint old, inout uint at)
{
    for (; flags != 0u; flags &= flags - 1u) {
        uint bit = uint(findLSB(flags)), section = first + bit;
        uint key = keyOf(section, (old >> bit & 1u) != 0u);
        scratch.words[SLUICE_SCAN_LIST + at++] = section | key << SLUICE_SCAN_KEY_SHIFT;
    }
}

void listQuad(uint quad, uvec4 flags, uint at)
{
    uvec4 valid = validBits(quad), old = postponed.quads[quad];
    for (uint i = 0u; i < 4u; i++)
        listFlags((quad * 4u + i) * 32u, flags[i], old[i], at);
    sections.quads[quad] &= ~valid;
    postponed.quads[quad] = old & ~valid;
}

void main()
{
    uint quadEnd = (params.sectionEnd + 127u) / 128u, listed = 0u, total;
    if (gl_LocalInvocationIndex == 0u)
        found = 0u;
    barrier();
    for (uint round = 0u; round * group < quadEnd; round++) {
        uint quad = round * group + gl_LocalInvocationIndex;
        uvec4 flags = quad < quadEnd ? sections.quads[quad] & validBits(quad) : uvec4(0u);
        if (!anyFlag(round, flags))
            continue;
        ivec4 bits = bitCount(flags);
        uint count = uint(bits.x + bits.y + bits.z + bits.w);
        uint before = sluiceSumBefore(count, total);
        if (count > 0u)
            listQuad(quad, flags, listed + before);
        listed += total;
    }
    if (gl_LocalInvocationIndex > 0u)
        return;
    uint groups = sluiceScanGroups(listed);
    scratch.words[0] = min(groups, SLUICE_SCAN_ROW);
    scratch.words[1] = (groups + SLUICE_SCAN_ROW - 1u) / SLUICE_SCAN_ROW;
    scratch.words[2] = 1u;
    scratch.words[SLUICE_SCAN_SECTION_COUNT] = listed;
}
