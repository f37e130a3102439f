/*
 * What host and shaders share for demand loading, see sluice/demand.glsl.
 *
 * Everything that can be missing is a page with an id. Shaders look pages up in two steps, so that
 * memory follows what is resident: one word of the directory for 32 pages says where their block
 * is, a block has a word per page. A page that is missed sets its bit among the requests, and the
 * bit of its section, which is how the scan finds it.
 *
 * The first ids are those of textures: page i "opens" the texture at index i. A texture that is
 * open has pages of its own for the tiles of each regular level, row by row, and one for all
 * coarser levels, its tail. Pages of one section have one rank: the coarser, the lower, the sooner
 * served.
 */
#ifndef SLUICE_SHARED_DEMAND_H
#define SLUICE_SHARED_DEMAND_H

#include "texture_table.h"
#include "types.h"

#define SLUICE_DEMAND_BLOCK_PAGES 32     /* one word of requests, one of the directory */
#define SLUICE_DEMAND_SECTION_PAGES 1024 /* one bit of sections */
#define SLUICE_DEMAND_RANKS 16

/* In the directory: none of the 32 pages is resident. Blocks begin at 1. */
#define SLUICE_DEMAND_NO_BLOCK 0

/*
 * A block: a word per page, then the second words of pages with 64 bits. Of tiles the word is chunk
 * << 16 | layer. The masks are apart: see SluiceDemandBlockMasks.
 */
#define SLUICE_DEMAND_BLOCK_WORDS 64

/* Of a tile's word, and of nothing else: SLUICE_PAGE_NONE is not resident, as a cleared bit of the
 * mask is; this one will not be, so it is not asked for: take a coarser level. */
#define SLUICE_DEMAND_PAGE_REFUSED 0xFFFFFFFEu

struct SluiceDemandBlockMasks {
    uint resident; /* a bit per page: its words count. Written by the host */
    uint used;     /* a bit per page: looked up since the host took the bits. Written by shaders */
};
SLUICE_SHARED_SIZE(struct SluiceDemandBlockMasks, 8)

/* SluiceDemandTexture.state */
#define SLUICE_DEMAND_TEXTURE_UNKNOWN                                                              \
    0 /* nobody has asked for it: request the page of its index                                    \
       */
#define SLUICE_DEMAND_TEXTURE_OPEN 1
#define SLUICE_DEMAND_TEXTURE_FAILED 2 /* its samples are baseColor, and count as resident */
#define SLUICE_DEMAND_TEXTURE_UDIM 3   /* a grid: sizes in textures, `levels` has their indices */

/* SluiceDemandTexture.shape */
#define SLUICE_DEMAND_TILE_HEIGHT_SHIFT 5  /* below: log2 of a tile's width; here of its height */
#define SLUICE_DEMAND_LEVEL_COUNT_SHIFT 10 /* 5 bits */
#define SLUICE_DEMAND_REGULAR_SHIFT 15     /* 5 bits: how many levels have tiles */
#define SLUICE_DEMAND_MODE_U_SHIFT 20      /* 3 bits, SLUICE_ADDRESS_MODE_... */
#define SLUICE_DEMAND_MODE_V_SHIFT 23
#define SLUICE_DEMAND_COMPONENTS_SHIFT 26       /* 3 bits: of the format */
#define SLUICE_DEMAND_NEAREST 0x20000000u       /* no filter between texels */
#define SLUICE_DEMAND_NEAREST_LEVEL 0x40000000u /* none between levels */
#define SLUICE_DEMAND_BLOCKS 0x80000000u /* block-compressed: the tail begins at multiples of 4 */

/* No texture in this place of a UDIM grid: its samples are the grid's baseColor. */
#define SLUICE_DEMAND_NO_TEXTURE 0xFFFFFFFFu

struct SluiceDemandTexture {
    uint state;
    uint width, height; /* texels of level 0; level l has max(1, size >> l) */
    uint shape;
    uint levels;   /* first word in the buffer of levels: the first page of each regular level */
    uint tailPage; /* one tile with all other levels: see demand_texels.glsl */
    float maxAnisotropy; /* 1 to 64 */
    float lodBias;
    float baseColor[4]; /* of the last level, where a texture fits inside a pixel */
    float borderColor[4];
};
SLUICE_SHARED_SIZE(struct SluiceDemandTexture, 64)

/* First words of the buffer of levels. */
#define SLUICE_DEMAND_PARAMETER_LOD_BIAS 0 /* float bits: added to all, while memory is short */
#define SLUICE_DEMAND_PARAMETER_TRACKING 1 /* 0: the used bits are not wanted */
#define SLUICE_DEMAND_PARAMETER_COUNT 4

/*
 * The scan of the requests: lists pages by age (postponed ones first), rank and id, clears what it
 * lists, counts the rest. Written into host memory:
 */
struct SluiceDemandScanResult {
    uint listedCount;    /* pages that follow */
    uint requestCount;   /* bits that were set, listed or not */
    uint sectionCount;   /* that had any */
    uint postponedCount; /* bits that stay set, for the next scan: requestCount - listedCount */
};
SLUICE_SHARED_SIZE(struct SluiceDemandScanResult, 16)

#endif
