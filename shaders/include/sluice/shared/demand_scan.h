/*
 * Data that the host and the passes of shaders/demand share.
 *
 * The scan of requests has four passes. compact.comp lists the flagged sections. count.comp counts
 * their requests. place.comp turns counts into positions and writes the result. list.comp writes
 * page ids and clears what it has listed. Flagged sections are processed in groups of
 * SLUICE_SCAN_GROUP_SECTIONS, so all passes but the first cost time in proportion to the requests.
 * whole.comp does the same in one workgroup.
 *
 * The key of a section is its rank, plus SLUICE_DEMAND_RANKS if none of its bits is left over from
 * an earlier scan. Positions are prefix sums over keys, then groups, then sections: equal requests
 * always give the same list.
 */
#ifndef SLUICE_SHARED_DEMAND_SCAN_H
#define SLUICE_SHARED_DEMAND_SCAN_H

#include "demand.h"

#define SLUICE_SCAN_GROUP_SECTIONS 32
#define SLUICE_SCAN_GROUP_SIZE 128 /* four invocations per section */
#define SLUICE_SCAN_KEYS 32        /* twice SLUICE_DEMAND_RANKS */
/* Words per group: requests of each key, then the number of sections with requests. */
#define SLUICE_SCAN_SUMS 33
/*
 * Workgroups of count.comp and list.comp, which share the groups of sections. The number is fixed:
 * a device waits longer for the arguments of an indirect dispatch than these workgroups take to
 * find nothing to do.
 */
#define SLUICE_SCAN_WORKGROUPS 128
/*
 * Largest sizes of the one workgroup of compact.comp and of place.comp. Specialization constant 0,
 * a power of two.
 */
#define SLUICE_SCAN_COMPACT_SIZE 256
#define SLUICE_SCAN_PLACE_SIZE 1024

/*
 * Scratch buffer: number of listed sections; then the list, section | key << SLUICE_SCAN_KEY_SHIFT;
 * then the sums.
 */
#define SLUICE_SCAN_SECTION_COUNT 0
#define SLUICE_SCAN_LIST 1
#define SLUICE_SCAN_KEY_SHIFT 27

struct SluiceDemandScanParams {
    uint sectionEnd;   /* sections from here on are ignored */
    uint firstSum;     /* word of the scratch buffer */
    uint resultOffset; /* words in the readback buffer, a multiple of 4; page ids follow */
    uint capacity;     /* page ids */
};
SLUICE_SHARED_SIZE(struct SluiceDemandScanParams, 16)

/* Changes of the page table: each changes a word, no word twice. */
#define SLUICE_PATCH_GROUP_SIZE 128
/* Workgroups in a row of a dispatch. Every device supports almost twice as many. */
#define SLUICE_PATCH_ROW 32768
#define SLUICE_PATCH_BUFFER_SHIFT 30
#define SLUICE_PATCH_DIRECTORY 0
#define SLUICE_PATCH_BLOCKS 1
#define SLUICE_PATCH_MASKS 2

struct SluiceDemandPatch {
    uint target; /* word | buffer << SLUICE_PATCH_BUFFER_SHIFT */
    uint value;
};
SLUICE_SHARED_SIZE(struct SluiceDemandPatch, 8)

struct SluiceDemandPatchParams {
    uint count;  /* patches; blocks, where used bits are taken */
    uint offset; /* words in the readback buffer, where used bits are taken */
};
SLUICE_SHARED_SIZE(struct SluiceDemandPatchParams, 8)

#endif
