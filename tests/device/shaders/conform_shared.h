/* One sample of the conformance tests, for C and GLSL. */
#ifndef CONFORM_SHARED_H
#define CONFORM_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

/* Ways to find the level of a sample. */
#define CONFORM_GRAD 0u     /* dx, dy, lodBias, maxAnisotropy */
#define CONFORM_LOD 1u      /* lod */
#define CONFORM_IMPLICIT 2u /* fragments: dx and dy become those of the quad */
#define CONFORM_QUAD 3u     /* CONFORM_GRAD with a corner per pixel of a quad */
#define CONFORM_TURNS 4u    /* CONFORM_GRAD with a corner in each of four frames */

/* The fragment stage has a quad per sample. */
#define CONFORM_TARGET_SIZE 128u
#define CONFORM_CAPACITY 4096u

struct ConformInput {
    float uv[2];
    float dx[2];
    float dy[2];
    float lodBias;
    float maxAnisotropy;
    float lod;
    uint tableIndex; /* each sample has a map of its own */
    uint mode;
    uint reserved;
};
SLUICE_SHARED_SIZE(struct ConformInput, 48)

#endif
