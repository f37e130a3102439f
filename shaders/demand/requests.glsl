/*
 * Requests of a group of sections. Four invocations share a section; each has 256 pages. Workgroups
 * have SLUICE_SCAN_GROUP_SIZE invocations.
 */
#ifndef SLUICE_DEMAND_REQUESTS_GLSL
#define SLUICE_DEMAND_REQUESTS_GLSL

#include "scan.glsl"

#define SLUICE_SCAN_PARTS 4u /* parts of a section */
#define SLUICE_SCAN_PART_QUADS 2u

shared uint entries[SLUICE_SCAN_GROUP_SECTIONS]; /* entries of the section list */
shared uint counts[SLUICE_SCAN_GROUP_SIZE];      /* requests of each part */
shared uint totals[SLUICE_SCAN_GROUP_SECTIONS];  /* requests of each section; 0 beyond the last */

uint sluiceCountBits(uvec4 words)
{
    ivec4 counts = bitCount(words);
    return uint(counts.x + counts.y + counts.z + counts.w);
}

/** Returns the first quad of this invocation's part of its section. */
uint sluicePartQuad(uint entry)
{
    uint part = gl_LocalInvocationIndex % SLUICE_SCAN_PARTS;
    return (sluiceScanSection(entry) * SLUICE_SCAN_PARTS + part) * SLUICE_SCAN_PART_QUADS;
}

/** Fills counts, totals and entries from what each invocation has. */
void sluiceShareCounts(uint entry, uvec4 low, uvec4 high)
{
    uint at = gl_LocalInvocationIndex, section = at / SLUICE_SCAN_PARTS;
    counts[at] = sluiceCountBits(low) + sluiceCountBits(high);
    if (at % SLUICE_SCAN_PARTS == 0u)
        entries[section] = entry;
    barrier();
    if (at < SLUICE_SCAN_GROUP_SECTIONS) {
        uint first = at * SLUICE_SCAN_PARTS;
        totals[at] = counts[first] + counts[first + 1u] + counts[first + 2u] + counts[first + 3u];
    }
    barrier();
}

#endif
