/* Inputs and outputs of the probe shader, for C and GLSL. */
#ifndef PROBE_SHARED_H
#define PROBE_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define PROBE_SAMPLE 1u
#define PROBE_FEEDBACK 2u
#define PROBE_RESIDENCY 4u
#define PROBE_FETCH 8u  /* uv are texel coordinates, lodBias the level */
#define PROBE_WORDS 16u /* copies feedback words instead */
#define PROBE_TWINS 32u /* evaluates the functions that have C twins */
/* textureGrad of the whole texture. Clamped at -1 - lodBias if the sampler clamps. With lodBias >=
 * 0: that many levels coarser, in a row of samples along the longer derivative, as in paged
 * residency. */
#define PROBE_TRUTH 64u
/* sluiceSampleDerivatives: red, green and blue of both derivatives go to footprint */
#define PROBE_SLOPES 128u

#define PROBE_PAGE_CHUNKS 64 /* descriptors of page images */

/* Flags of the picture shader, whose `first` is the frame. */
#define PICTURE_SIZE 128u
#define PICTURE_LATTICE 1u

/* Flag of the array shaders, whose flags are the layer: each sample has its own layer, from
 * tableIndex on. */
#define PROBE_ALL_LAYERS 0x80000000u

struct ProbeInput {
    float uv[2];
    float dx[2];
    float dy[2];
    float lodBias;
    float maxAnisotropy;
};
SLUICE_SHARED_SIZE(struct ProbeInput, 32)

struct ProbeOutput {
    float color[4];
    uint missingLevels;
    uint level;
    uint nonResident; /* summed over the dispatches */
    uint wantedLevel;
    float lod;
    uint footprint[6]; /* bits of dx and dy that textureGrad gets */
    float minLod;
};
SLUICE_SHARED_SIZE(struct ProbeOutput, 64)

struct ProbeParams {
    uint tableIndex;
    uint first;
    uint count;
    uint flags;
};
SLUICE_SHARED_SIZE(struct ProbeParams, 16)

#endif
