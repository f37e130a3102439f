/*
 * Streamed texture as shaders see it: an element of the texture table, a std430 array.
 *
 * A region is the area of a tile of level 0. The feedback buffer has one word per region. So has
 * the MinMip buffer: the low half is the region's texel, the high half the largest texel of the
 * regions around it. Both are stored row by row.
 */
#ifndef SLUICE_SHARED_TEXTURE_TABLE_H
#define SLUICE_SHARED_TEXTURE_TABLE_H

#include "types.h"

/* In feedback: nothing was sampled. As a level to sample: not even packed levels are resident. */
#ifndef SLUICE_MIP_UNTOUCHED
#define SLUICE_MIP_UNTOUCHED 255
#endif

/*
 * Values of the MinMip buffer: the finest LOD that may be shown, in steps, plus a margin (the
 * largest sluiceLodMargin). 0: everything may be shown. _NOTHING and above: not even packed levels.
 * While a region gets sharper its value falls step by step (docs/frame-loop.md). Tiles of levels
 * from (value - margin) / steps on are resident.
 */
#define SLUICE_SHOWN_STEPS 256
#define SLUICE_SHOWN_MARGIN 48
#define SLUICE_SHOWN_NOTHING 0xFF00

/*
 * Reach of a sample to each side, in texels of level 0, as a multiple of the root of the sum of its
 * squared derivatives (at least 1). Covers a whole anisotropic footprint, and 0.5625 texels of a
 * level up to 1.125 levels coarser than its LOD.
 */
#define SLUICE_REACH 2.25
#define SLUICE_REACH_SPLINE 4.5 /* for textures with a bicubic filter: 1.5625 texels */
/* Reach of "around" in regions, and for ragged regions. */
#define SLUICE_AROUND 1
#define SLUICE_AROUND_RAGGED 2

/* Values of VkSamplerAddressMode. */
#define SLUICE_ADDRESS_MODE_REPEAT 0
#define SLUICE_ADDRESS_MODE_MIRRORED_REPEAT 1
#define SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE 2
#define SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER 3
#define SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE 4

/* Some level's size is not half of the next finer one's, so tiles do not cover regions exactly. */
#define SLUICE_TEXTURE_FLAG_UNEVEN 1
#define SLUICE_TEXTURE_FLAG_SPLINE 2 /* bicubic filter */
#define SLUICE_TEXTURE_FLAG_SMART 4  /* bicubic only where the texture is magnified */
/* An ordinary image with all levels, whatever the mode of the streamer. */
#define SLUICE_TEXTURE_FLAG_DENSE 8
#define SLUICE_TEXTURE_FLAG_PAGED 16 /* its regular tiles are pages */
/* Three bits of the flags: number of components of the format. */
#define SLUICE_TEXTURE_COMPONENTS_SHIFT 8

/*
 * Page table of paged mode. At a texture's offset: one word per regular level, the index of its
 * first tile's word. Then one word per tile: chunk << 16 | layer, or SLUICE_PAGE_NONE.
 */
#define SLUICE_PAGE_NONE 0xFFFFFFFFu

/*
 * SluiceTextureEntry.shape holds what footprints need in one word: log2 of a region's width and
 * height, 5 bits each; address modes, 3 bits each; last level, 5 bits; flags.
 */
#define SLUICE_SHAPE_HEIGHT_SHIFT 5
#define SLUICE_SHAPE_MODE_U_SHIFT 10
#define SLUICE_SHAPE_MODE_V_SHIFT 13
#define SLUICE_SHAPE_LAST_LEVEL_SHIFT 16
#define SLUICE_SHAPE_UNEVEN 0x200000u  /* SLUICE_TEXTURE_FLAG_UNEVEN */
#define SLUICE_SHAPE_REPEATS 0x400000u /* along both axes */
#define SLUICE_SHAPE_QUICK 0x800000u   /* powers of two that repeat or clamp along both axes */
#define SLUICE_SHAPE_SPLINE 0x1000000u /* SLUICE_TEXTURE_FLAG_SPLINE */
#define SLUICE_SHAPE_SMART 0x2000000u
#define SLUICE_SHAPE_PAGED 0x4000000u /* SLUICE_TEXTURE_FLAG_PAGED */

struct SluiceTextureEntry {
    /* Members that most samples read: */
    float sizeX; /* width */
    float sizeY;
    uint shape;
    uint wholeShown;  /* largest texel of the MinMip map; 0: all texels may be shown */
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
    uint addressModeU; /* address modes of the samplers that shaders use */
    uint addressModeV;
    uint flags;
    uint pageTableOffset; /* paged: first word in the page table */
    uint tileShift;       /* log2 of a tile's width, and of its height << 8; paged */
    float quickReach2;    /* samples with a smaller sum of squared derivatives touch regions around
                             only */
    float quickPacked2;   /* samples with a sum from here on touch packed levels only */
    uint samplerIndex;    /* in the array of samplers, if bound (bindings.glsl) */
};
SLUICE_SHARED_SIZE(struct SluiceTextureEntry, 96)

#endif
