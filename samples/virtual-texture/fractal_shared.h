/* What C and the shaders of virtual-texture share. */
#ifndef FRACTAL_SHARED_H
#define FRACTAL_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define FRACTAL_GROUP 8u
#define FRACTAL_MOST_STEPS 255u /* a texel is a byte */

/* Texels to be made, and where they go. */
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
    uint sizeLog2; /* of the texture */
};
SLUICE_SHARED_SIZE(struct FractalMake, 8)

/* Push constants of view.comp. */
struct FractalView {
    float centerX, centerY; /* 0 to 1 */
    float scale;            /* of a pixel, in the same unit */
    uint width, height;     /* pixels */
    uint tableIndex;
    uint sizeLog2;
    uint compares; /* counts texels that are not what the function gives */
};
SLUICE_SHARED_SIZE(struct FractalView, 32)

struct FractalCounts {
    uint compared; /* texels */
    uint wrong;
    uint coarse; /* pixels that show a coarser level than they want */
    uint finest; /* level that a pixel shows */
};
SLUICE_SHARED_SIZE(struct FractalCounts, 16)

#endif
