/* Structs and constants that C and the shaders of virtual-texture share. */
#ifndef FRACTAL_SHARED_H
#define FRACTAL_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define FRACTAL_GROUP 8u
#define FRACTAL_MOST_STEPS 255u /* a texel is a byte */

/* A tile to make: its texels in the texture, and the place to write them. */
struct FractalTile {
    uint level;
    uint x, y;
    uint width, height;
    uint targetX, targetY, layer;
};
SLUICE_SHARED_SIZE(struct FractalTile, 32)

/* Push constants of make.comp. */
struct FractalMake {
    uint firstTile;
    uint sizeLog2; /* log2 of the width of the texture */
};
SLUICE_SHARED_SIZE(struct FractalMake, 8)

/* Push constants of view.comp. */
struct FractalView {
    float centerX, centerY; /* in texture coordinates, 0 to 1 */
    float scale;            /* width of a pixel, in texture coordinates */
    uint width, height;     /* pixels */
    uint tableIndex;
    uint sizeLog2;
    uint compares; /* not 0: compares each texel with the function */
};
SLUICE_SHARED_SIZE(struct FractalView, 32)

struct FractalCounts {
    uint compared; /* texels */
    uint wrong;
    uint coarse; /* pixels that show a coarser level than requested */
    uint finest; /* finest level that a pixel shows */
};
SLUICE_SHARED_SIZE(struct FractalCounts, 16)

#endif
