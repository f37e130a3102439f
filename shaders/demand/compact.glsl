/*
 * Lists the flagged sections by id, each with its key, and clears the flags, in one workgroup. Later
 * passes set flags again for remaining bits.
 */
#include "prefix.glsl"
#include "scan.glsl"

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

uvec4 readFlags(uint quad)
{
    uint at = quad * 4u;
    return uvec4(sections.words[at], sections.words[at + 1u], sections.words[at + 2u],
                 sections.words[at + 3u]);
}

void listQuad(uint quad, uvec4 flags, uint at)
{
    uvec4 valid = validBits(quad);
    for (uint i = 0u; i < 4u; i++) {
        uint old = postponed.words[quad * 4u + i];
        listFlags((quad * 4u + i) * 32u, flags[i], old, at);
        sections.words[quad * 4u + i] &= ~valid[i];
        postponed.words[quad * 4u + i] = old & ~valid[i];
    }
}

void sluiceCompactSections()
{
    uint quadEnd = (params.sectionEnd + 127u) / 128u, listed = 0u, total;
    if (gl_LocalInvocationIndex == 0u)
        found = 0u;
    barrier();
    for (uint round = 0u; round * group < quadEnd; round++) {
        uint quad = round * group + gl_LocalInvocationIndex;
        uvec4 flags = quad < quadEnd ? readFlags(quad) & validBits(quad) : uvec4(0u);
        if (!anyFlag(round, flags))
            continue;
        ivec4 bits = bitCount(flags);
        uint count = uint(bits.x + bits.y + bits.z + bits.w);
        uint before = sluiceSumBefore(count, total);
        if (count > 0u)
            listQuad(quad, flags, listed + before);
        listed += total;
    }
    if (gl_LocalInvocationIndex == 0u)
        scratch.words[SLUICE_SCAN_SECTION_COUNT] = listed;
}
