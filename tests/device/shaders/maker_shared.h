/* Tiles that the maker shader writes, for C and GLSL. */
#ifndef MAKER_SHARED_H
#define MAKER_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define MAKER_GROUP 8u

struct MakerTile {
    uint level;
    uint x, y;
    uint width, height;
    uint targetX, targetY, layer;
};
SLUICE_SHARED_SIZE(struct MakerTile, 32)

#endif
