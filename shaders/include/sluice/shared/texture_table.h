/*
 * One streamed texture, as shaders see it: an element of the texture table, a std430 array.
 *
 * A region is the area of a tile of level 0. The feedback buffer has one word per region, and so
 * has the MinMip buffer: its own texel in the low half, the largest one of the regions around it in
 * the high half. Both row by row.
 */
#ifndef SLUICE_SHARED_TEXTURE_TABLE_H
#define SLUICE_SHARED_TEXTURE_TABLE_H

#include "types.h"

/* In feedback: nothing was sampled. As a level of what may be sampled: not even packed levels. */
#ifndef SLUICE_MIP_UNTOUCHED
#define SLUICE_MIP_UNTOUCHED 255
#endif

/*
 * In the MinMip buffer: the finest level of detail that may be shown, in steps, and a margin on
 * top, the largest of sluiceLodMargin; 0 where all may be, and from _NOTHING on where not even the
 * packed levels may. While a region gets sharper the value sinks step by step: see
 * docs/frame-loop.md. The tiles of levels from (value - margin) / steps on are resident.
 */
#define SLUICE_SHOWN_STEPS 256
#define SLUICE_SHOWN_MARGIN 48
#define SLUICE_SHOWN_NOTHING 0xFF00

/*
 * Texels of level 0 that a sample reaches to each side, as a multiple of the root of the sum of its
 * squared derivatives, at least 1: all of it for an anisotropic footprint, and 0.5625 texels of a
 * level up to one and an eighth coarser than it leads to.
 */
#define SLUICE_REACH 2.25
/* How far "around" goes, in regions, and where regions are ragged. */
#define SLUICE_AROUND 1
#define SLUICE_AROUND_RAGGED 2

/* As VkSamplerAddressMode. */
#define SLUICE_ADDRESS_MODE_REPEAT 0
#define SLUICE_ADDRESS_MODE_MIRRORED_REPEAT 1
#define SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE 2
#define SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER 3
#define SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE 4

/* A level's size is not the next finer one's halved, so tiles do not cover regions exactly. */
#define SLUICE_TEXTURE_FLAG_UNEVEN 1
/* Among the flags: how many components the format has, in three bits. */
#define SLUICE_TEXTURE_COMPONENTS_SHIFT 8

/*
 * The page table, in paged residency: at a texture's offset one word per regular level, the index
 * of its first tile's word; and one word per tile: chunk << 16 | layer, or this.
 */
#define SLUICE_PAGE_NONE 0xFFFFFFFFu

/*
 * SluiceTextureEntry.shape, all that footprints need in a word: log2 of a region's width and
 * height, 5 bits each; the address modes, 3 bits each; the last level, 5 bits; and flags.
 */
#define SLUICE_SHAPE_HEIGHT_SHIFT 5
#define SLUICE_SHAPE_MODE_U_SHIFT 10
#define SLUICE_SHAPE_MODE_V_SHIFT 13
#define SLUICE_SHAPE_LAST_LEVEL_SHIFT 16
#define SLUICE_SHAPE_UNEVEN 0x200000u  /* as SLUICE_TEXTURE_FLAG_UNEVEN */
#define SLUICE_SHAPE_REPEATS 0x400000u /* along both axes */
#define SLUICE_SHAPE_QUICK 0x800000u   /* powers of two, which repeat or clamp along both axes */

struct SluiceTextureEntry {
    /* What most samples read: */
    float sizeX; /* width */
    float sizeY;
    uint shape;
    uint wholeShown;  /* the largest texel of its MinMip map: 0 while all of it may be shown */
    uint regionLastX; /* regionCountX - 1 */
    uint regionLastY;
    uint minMipOffset;   /* first word in the MinMip buffer */
    uint feedbackOffset; /* first word in the feedback buffer */

    uint width; /* texels of level 0; level l has max(1, size >> l) */
    uint height;
    uint mipLevelCount;
    uint regularMipCount; /* levels from here on are packed */
    uint regionWidth;     /* texels of level 0 */
    uint regionHeight;
    uint regionCountX;
    uint regionCountY;
    uint addressModeU; /* of the samplers that it is sampled with */
    uint addressModeV;
    uint flags;
    uint pageTableOffset; /* paged: first word in the page table */
    uint tileShift;       /* log2 of a tile's width, and of its height << 8; paged */
    float quickReach2; /* samples of a smaller sum of squared derivatives touch regions around alone
                        */
    float quickPacked2; /* samples of squared derivatives from there on touch packed levels alone */
    uint reserved;
};
SLUICE_SHARED_SIZE(struct SluiceTextureEntry, 96)

#endif
