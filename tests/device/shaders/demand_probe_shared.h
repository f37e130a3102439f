/* Inputs and outputs of the demand loading probe, for C and GLSL. */
#ifndef DEMAND_PROBE_SHARED_H
#define DEMAND_PROBE_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

/* Operations at an input. */
#define DEMAND_GRAD 0u
#define DEMAND_LOD 1u
#define DEMAND_CUBIC 2u
#define DEMAND_MAP 3u      /* a page of a resource: `index` */
#define DEMAND_FORMULA 4u  /* the LOD only; dx and dy in texels, maxAnisotropy in `lod` */
#define DEMAND_HARDWARE 5u /* an ordinary image by its sampler, with dx and dy */
#define DEMAND_PLACE 6u    /* tail level `lod` of a texture's shape */
#define DEMAND_SLOPES 7u   /* DEMAND_GRAD with derivatives */

#define DEMAND_CHUNKS 2 /* array images */

struct DemandInput {
    float uv[2];
    float dx[2];
    float dy[2];
    float lod;
    uint kind;
    uint index; /* index of the texture */
    uint word;  /* DEMAND_PLACE: word of the tail's page */
    uint reserved[2];
};
SLUICE_SHARED_SIZE(struct DemandInput, 48)

struct DemandOutput {
    float color[4];
    uint resident;
    float lod;
    uint value[2];
    float du[4];
    float dv[4];
};
SLUICE_SHARED_SIZE(struct DemandOutput, 64)

#endif
