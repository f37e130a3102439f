/*
 * Writes the ids of a group's requests to their places and clears the requests. Requests without a
 * place stay set and flag their section for the next scan.
 */
#extension GL_EXT_control_flow_attributes : require

#include "requests.glsl"

#define WINDOW 2048u /* ids that are written together */
#define PART_PAGES (SLUICE_DEMAND_SECTION_PAGES / SLUICE_SCAN_PARTS)

shared uint places[SLUICE_SCAN_GROUP_SECTIONS];      /* place of the section's first request */
shared uint listedCounts[SLUICE_SCAN_GROUP_SECTIONS];
shared uint starts[SLUICE_SCAN_GROUP_SECTIONS + 1u]; /* sums of listedCounts */
shared uint staged[WINDOW];                          /* section of the group << 10 | page of it */

/* Bits of one part that remain to be listed, lowest first. */
struct Cursor {
    uint words[8];
    uint left;
    uint at; /* place of the next request, within the group */
};

/** Returns the number of requests with this key in the first `end` sections of the group. */
uint countKey(uint key, uint end)
{
    uint sum = 0u;
    for (uint i = 0u; i < end; i++)
        sum += entries[i] >> SLUICE_SCAN_KEY_SHIFT == key ? totals[i] : 0u;
    return sum;
}

void placeSections(uint groups, uint scanGroup)
{
    uint at = gl_LocalInvocationIndex;
    if (at < SLUICE_SCAN_GROUP_SECTIONS) {
        uint key = entries[at] >> SLUICE_SCAN_KEY_SHIFT;
        places[at] = scratch.words[params.firstSum + key * groups + scanGroup] + countKey(key, at);
        listedCounts[at] = min(totals[at], params.capacity - min(places[at], params.capacity));
    }
    barrier();
    if (at <= SLUICE_SCAN_GROUP_SECTIONS) {
        uint sum = 0u;
        for (uint i = 0u; i < at; i++)
            sum += listedCounts[i];
        starts[at] = sum;
    }
    barrier();
}

Cursor beginPart(uvec4 low, uvec4 high)
{
    uint at = gl_LocalInvocationIndex, section = at / SLUICE_SCAN_PARTS, before = 0u;
    for (uint i = section * SLUICE_SCAN_PARTS; i < at; i++)
        before += counts[i];
    uint room = listedCounts[section] - min(before, listedCounts[section]);
    return Cursor(uint[8](low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w),
                  min(counts[at], room), starts[section] + before);
}

/** Takes bits out of the cursor until the window ends. Unrolled, so that words stay in registers. */
void stage(inout Cursor cursor, uint windowFirst)
{
    uint at = gl_LocalInvocationIndex, section = at / SLUICE_SCAN_PARTS;
    uint first = section * SLUICE_DEMAND_SECTION_PAGES + at % SLUICE_SCAN_PARTS * PART_PAGES;
    [[unroll]] for (uint word = 0u; word < 8u; word++) {
        uint bits = cursor.words[word];
        while (bits != 0u && cursor.left > 0u && cursor.at - windowFirst < WINDOW) {
            staged[cursor.at - windowFirst] = first + word * 32u + uint(findLSB(bits));
            bits &= bits - 1u;
            cursor.left--;
            cursor.at++;
        }
        cursor.words[word] = bits;
    }
}

/* Neighbors write neighbors: words that go to the host one by one are as slow as lines of them. */
void writeWindow(uint first, uint end)
{
    for (uint at = first + gl_LocalInvocationIndex; at < end; at += SLUICE_SCAN_GROUP_SIZE) {
        uint page = staged[at - first], section = page / SLUICE_DEMAND_SECTION_PAGES;
        uint place = places[section] + (at - starts[section]);
        readback.words[params.resultOffset + 4u + place] =
            sluiceScanSection(entries[section]) * SLUICE_DEMAND_SECTION_PAGES +
            page % SLUICE_DEMAND_SECTION_PAGES;
    }
}

/** The flags of a section of which bits stay. */
void postpone(uint section)
{
    uint id = sluiceScanSection(entries[section]);
    atomicOr(sections.words[id / 32u], 1u << id % 32u);
    atomicOr(postponed.words[id / 32u], 1u << id % 32u);
}

void sluiceListGroup(uint scanGroup, uint sectionCount, uint groups)
{
    uint at = gl_LocalInvocationIndex;
    uint index = scanGroup * SLUICE_SCAN_GROUP_SECTIONS + at / SLUICE_SCAN_PARTS;
    bool listed = index < sectionCount;
    uint entry = listed ? scratch.words[SLUICE_SCAN_LIST + index] : 0u;
    uint quad = sluicePartQuad(entry);
    uvec4 low = listed ? requests.quads[quad] : uvec4(0u);
    uvec4 high = listed ? requests.quads[quad + 1u] : uvec4(0u);
    sluiceShareCounts(entry, low, high);
    placeSections(groups, scanGroup);
    Cursor cursor = beginPart(low, high);
    bool clears = cursor.left > 0u;
    uint end = starts[SLUICE_SCAN_GROUP_SECTIONS];
    for (uint first = 0u; first < end; first += WINDOW) {
        stage(cursor, first);
        barrier();
        writeWindow(first, min(first + WINDOW, end));
        barrier();
    }
    if (clears) {
        uint words[8] = cursor.words;
        requests.quads[quad] = uvec4(words[0], words[1], words[2], words[3]);
        requests.quads[quad + 1u] = uvec4(words[4], words[5], words[6], words[7]);
    }
    if (at < SLUICE_SCAN_GROUP_SECTIONS && listedCounts[at] < totals[at])
        postpone(at);
    barrier(); /* the next group may begin */
}
