/*
 * Data that the host and the passes of shaders/resolve share.
 *
 * A frame resolves the feedback of some textures, its items, in the order given by the host. Each
 * item is cut into segments of SLUICE_RESOLVE_SEGMENT_SIZE regions, one workgroup per segment. Four
 * regions share a word of packed levels, the first in the low byte.
 */
#ifndef SLUICE_SHARED_RESOLVE_H
#define SLUICE_SHARED_RESOLVE_H

#include "feedback.h"
#include "types.h"

#define SLUICE_RESOLVE_GROUP_SIZE 64
#define SLUICE_RESOLVE_SEGMENT_SIZE 256
/* Largest size of the scan: a power of two that the device allows. */
#define SLUICE_RESOLVE_SCAN_GROUP_SIZE 1024
/* Workgroups in a row of a dispatch. Every device supports almost twice as many. */
#define SLUICE_RESOLVE_ROW 32768

/* SluiceResolveItem.flags: read back the whole map, whatever has changed. */
#define SLUICE_RESOLVE_WHOLE 1

/* SluiceResolveResult.state */
#define SLUICE_RESOLVED_NOTHING 0 /* no room: neither reported nor cleared, so nothing is lost */
#define SLUICE_RESOLVED_CHANGES 1 /* `count` words, region << 8 | level, regions ascending */
#define SLUICE_RESOLVED_MAP 2     /* `count` words of packed levels: all regions */

/* A change has 24 bits for the region. Larger maps are read back whole. */
#define SLUICE_RESOLVE_MAX_LISTED_REGIONS 0x1000000

/*
 * Specialization constants of the passes: 0 is the encoding (feedback.h), 1 the size of the scan's
 * workgroup.
 */

struct SluiceResolveSegment {
    uint firstRegion; /* in the buffers, a multiple of 4 */
    uint regionCount;
    uint item;
    uint offset; /* index of the first region in its texture */
};
SLUICE_SHARED_SIZE(struct SluiceResolveSegment, 16)

struct SluiceResolveItem {
    uint firstSegment;
    uint segmentCount;
    uint regionCount;
    uint flags;
};
SLUICE_SHARED_SIZE(struct SluiceResolveItem, 16)

/* Result of an item. Results are at the start of a readback slot; their words follow. */
struct SluiceResolveResult {
    uint state;
    uint count;    /* words */
    uint offset;   /* first word, counted from the slot's first word behind the results */
    uint checksum; /* sum over the whole map, see sluiceResolveWeight in resolve.glsl */
};
SLUICE_SHARED_SIZE(struct SluiceResolveResult, 16)

struct SluiceResolveParams {
    uint segmentCount;
    uint itemCount;
    uint firstSegment; /* in the table, 16 bytes each */
    uint firstItem;    /* in the table, 16 bytes each */
    uint resultOffset; /* words in the readback buffer, a multiple of 4 */
    uint dataOffset;   /* words in the readback buffer */
    uint capacity;     /* words from there on */
    uint scratchItem;  /* first place of the items in the scratch buffer, 8 bytes each */
};
SLUICE_SHARED_SIZE(struct SluiceResolveParams, 32)

#endif
