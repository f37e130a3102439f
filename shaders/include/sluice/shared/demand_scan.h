/*
 * What the host and the passes of shaders/demand tell each other.
 *
 * The scan of requests: compact.comp lists the sections that are flagged, count.comp counts their
 * requests, place.comp turns counts into places and writes the result, list.comp writes page ids
 * and clears what it has listed. Flagged sections are worked on in groups of
 * SLUICE_SCAN_GROUP_SECTIONS, so all but the first pass cost what was requested. whole.comp does
 * the same in one workgroup.
 *
 * A section's key is its rank, plus SLUICE_DEMAND_RANKS if none of its bits is left over from a
 * scan before. Places are prefix sums over keys, then groups, then sections: the same requests give
 * the same list every time.
 */
#ifndef SLUICE_SHARED_DEMAND_SCAN_H
#define SLUICE_SHARED_DEMAND_SCAN_H

#include "demand.h"

#define SLUICE_SCAN_GROUP_SECTIONS 32
#define SLUICE_SCAN_GROUP_SIZE 128 /* four invocations for each */
#define SLUICE_SCAN_KEYS 32        /* SLUICE_DEMAND_RANKS, twice */
/* Per group: requests of each key, then sections that had any. */
#define SLUICE_SCAN_SUMS 33
/* Workgroups of count.comp and list.comp, that share the groups of sections. As many every time:
 * a device waits longer for the arguments of an indirect dispatch than these take to find that
 * there is nothing to do. */
#define SLUICE_SCAN_WORKGROUPS 128
/* Sizes of the one workgroup of compact.comp and of place.comp, at most: specialization constant 0,
 * a power of two. */
#define SLUICE_SCAN_COMPACT_SIZE 256
#define SLUICE_SCAN_PLACE_SIZE 1024

/* Words at the start of the scratch buffer: how many sections are listed. The list follows: section
 * | key << SLUICE_SCAN_KEY_SHIFT. Then the sums. */
#define SLUICE_SCAN_SECTION_COUNT 0
#define SLUICE_SCAN_LIST 1
#define SLUICE_SCAN_KEY_SHIFT 27

struct SluiceDemandScanParams {
    uint sectionEnd;   /* sections from here on are not looked at */
    uint firstSum;     /* word of the scratch buffer */
    uint resultOffset; /* words in the readback buffer, a multiple of 4; page ids follow */
    uint capacity;     /* page ids */
};
SLUICE_SHARED_SIZE(struct SluiceDemandScanParams, 16)

/* Changes of the page table: each names a word, no word twice. */
#define SLUICE_PATCH_GROUP_SIZE 128
/* Workgroups in a row of a dispatch; what every device can do is just below the double. */
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
