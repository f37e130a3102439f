/* What the shaders of traced scenes and the host share. */
#ifndef TRACED_SHARED_H
#define TRACED_SHARED_H

#include "sluice/shared/types.h"

#define TRACED_NO_LEVEL 255u

/* TracedView.state */
#define TRACED_NOT_OPEN 0u
#define TRACED_OPEN 1u
#define TRACED_FAILED 2u

/* What a pixel has and wants of the first picture that its ray samples. */
struct TracedView {
    uint texture; /* of the loader; 0xffffffff: none. The rest is undefined then */
    uint state;
    float lod;     /* with all LOD biases but the loader's; undefined until the texture is open */
    float density; /* texels of level 0 per pixel, along the shorter side of the footprint */
    uint wanted;   /* finest level that `lod` samples */
    uint resident; /* finest level that is resident there; TRACED_NO_LEVEL: none */
    uint page;     /* of the resident level; 0xffffffff: it has none */
    uint levelCount;
    float uv[2]; /* 0 to 1 */
    uint reserved[2];
};
SLUICE_SHARED_SIZE(struct TracedView, 48)

#endif
