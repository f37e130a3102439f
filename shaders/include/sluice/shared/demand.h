/*
 * Data that host and shaders share for demand loading. See sluice/demand.glsl.
 *
 * Everything that can be missing is a page with an id. Shaders look up a page in two steps, so that
 * memory follows the resident pages: a word of the directory locates the block of 32 pages; the
 * block has a word per page. A missed page sets its bit in the requests and the bit of its section,
 * by which the scan finds it.
 *
 * The first ids belong to textures: page i "opens" the texture at index i. An open texture has
 * pages for the tiles of each regular level, row by row, and one page for all coarser levels, its
 * mip tail. Pages of one section have one rank. Coarser pages have a lower rank and are served
 * earlier.
 */
#ifndef SLUICE_SHARED_DEMAND_H
#define SLUICE_SHARED_DEMAND_H

#include "texture_table.h"
#include "types.h"

#define SLUICE_DEMAND_BLOCK_PAGES 32     /* one word of requests, one of the directory */
#define SLUICE_DEMAND_SECTION_PAGES 1024 /* one bit of sections */
#define SLUICE_DEMAND_RANKS 16

/* In the directory: none of the 32 pages is resident. Blocks count from 1. */
#define SLUICE_DEMAND_NO_BLOCK 0

/*
 * Block: a word per page, then the second words of 64-bit pages. For tiles the word is chunk << 16
 * | layer. Masks are stored separately (SluiceDemandBlockMasks).
 */
#define SLUICE_DEMAND_BLOCK_WORDS 64

/*
 * Word of a mip tail: also the slot of the page that it has. A page of tails is cut into cells,
 * each of two or three slots. See demand_texels.glsl.
 */
#define SLUICE_DEMAND_SLOT_SHIFT 11   /* 2 bits: 1 + slot in the cell; 0 in words of tiles */
#define SLUICE_DEMAND_CELL_SHIFT 13   /* 2 bits: 0: the cell is the page, else see SIDE below */
#define SLUICE_DEMAND_CELL_X_SHIFT 26 /* 3 bits: column of the cell in the page */
#define SLUICE_DEMAND_CELL_Y_SHIFT 29 /* 2 bits: row */
#define SLUICE_DEMAND_PLACE_MASK 0x03FF07FFu /* chunk << 16 | layer */
/* Cell n from 1 to 3 is a square of this side, in texels. */
#define SLUICE_DEMAND_CELL_SIDE(tileHeight, n) ((tileHeight) >> ((n)-1))

/*
 * Word of a tile that will not become resident: do not request it, use a coarser level.
 * (SLUICE_PAGE_NONE and a cleared bit of the mask mean not resident.)
 */
#define SLUICE_DEMAND_PAGE_REFUSED 0xFFFFFFFEu

struct SluiceDemandBlockMasks {
    uint resident; /* a bit per page: its words are valid. Written by the host */
    uint used; /* a bit per page: looked up since the host read the bits, or a tail whose texture
                  was sampled. Written by shaders */
};
SLUICE_SHARED_SIZE(struct SluiceDemandBlockMasks, 8)

/* SluiceDemandTexture.state */
#define SLUICE_DEMAND_TEXTURE_UNKNOWN                                                              \
    0 /* never requested: request the page of its index                                            \
       */
#define SLUICE_DEMAND_TEXTURE_OPEN 1
#define SLUICE_DEMAND_TEXTURE_FAILED 2 /* its samples are baseColor, and resident */
#define SLUICE_DEMAND_TEXTURE_GRID 3   /* sizes in textures, `levels` has their indices */

/* SluiceDemandTexture.shape. 4 bits from bit 0: log2 of a tile's width. */
#define SLUICE_DEMAND_SPLINE 0x10u         /* bicubic filter between texels */
#define SLUICE_DEMAND_TILE_HEIGHT_SHIFT 5  /* 4 bits: log2 of a tile's height */
#define SLUICE_DEMAND_SMART 0x200u         /* bicubic only where the texture is magnified */
#define SLUICE_DEMAND_LEVEL_COUNT_SHIFT 10 /* 5 bits */
#define SLUICE_DEMAND_REGULAR_SHIFT 15     /* 5 bits: how many levels have tiles */
#define SLUICE_DEMAND_MODE_U_SHIFT 20      /* 3 bits, SLUICE_ADDRESS_MODE_... */
#define SLUICE_DEMAND_MODE_V_SHIFT 23
#define SLUICE_DEMAND_COMPONENTS_SHIFT 26       /* 3 bits: of the format */
#define SLUICE_DEMAND_NEAREST 0x20000000u       /* no filter between texels */
#define SLUICE_DEMAND_NEAREST_LEVEL 0x40000000u /* none between levels */
#define SLUICE_DEMAND_BLOCKS 0x80000000u /* block-compressed: tail levels lie at multiples of 4 */

/* No texture in this cell of a grid: samples are the grid's baseColor. */
#define SLUICE_DEMAND_NO_TEXTURE 0xFFFFFFFFu

struct SluiceDemandTexture {
    uint state;
    uint width, height; /* texels of level 0; level l has max(1, size >> l) */
    uint shape;
    uint levels;   /* first word in the buffer of levels: the first page of each regular level */
    uint tailPage; /* all other levels: a slot of a page, see demand_texels.glsl. Grid: index of its
                      base texture; 0: none */
    float maxAnisotropy; /* 1 to 64 */
    float lodBias;
    float baseColor[4]; /* color of the last level, for textures smaller than a pixel */
    float borderColor[4];
};
SLUICE_SHARED_SIZE(struct SluiceDemandTexture, 64)

/* First words of the levels buffer. */
#define SLUICE_DEMAND_PARAMETER_LOD_BIAS 0 /* float bits: for all, while memory is short */
#define SLUICE_DEMAND_PARAMETER_TRACKING 1 /* 0: do not write used bits */
#define SLUICE_DEMAND_PARAMETER_COUNT 4

/*
 * Result of the scan of the requests, in host memory. The scan lists pages by age (postponed ones
 * first), rank and id, clears what it lists, and counts the rest.
 */
struct SluiceDemandScanResult {
    uint listedCount;    /* pages that follow */
    uint requestCount;   /* bits that were set, listed or not */
    uint sectionCount;   /* sections with requests */
    uint postponedCount; /* bits that stay set, for the next scan: requestCount - listedCount */
};
SLUICE_SHARED_SIZE(struct SluiceDemandScanResult, 16)

#endif
