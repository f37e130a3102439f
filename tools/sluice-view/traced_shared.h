/* Structures that the shaders of traced scenes and the host share. */
#ifndef TRACED_SHARED_H
#define TRACED_SHARED_H

#include "sluice/shared/types.h"

#define TRACED_NO_LEVEL 255u

/* TracedView.state */
#define TRACED_NOT_OPEN 0u
#define TRACED_OPEN 1u
#define TRACED_FAILED 2u

/* Resident and wanted level of a pixel, in the first picture that its ray samples. */
struct TracedView {
    uint texture; /* texture of the loader; 0xffffffff: none, other fields are undefined */
    uint state;
    float lod;     /* with all LOD biases but the loader's; undefined until the texture is open */
    float density; /* texels of level 0 per pixel, along the shorter side of the footprint */
    uint wanted;   /* finest level that `lod` samples */
    uint resident; /* finest level that is resident there; TRACED_NO_LEVEL: none */
    uint page;     /* page with the resident level; 0xffffffff: none */
    uint levelCount;
    float uv[2]; /* 0 to 1 */
    uint reserved[2];
};
SLUICE_SHARED_SIZE(struct TracedView, 48)

#endif
