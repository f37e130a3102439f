/* Inputs and outputs of demand_runner.comp. */
#ifndef TESTS_DEVICE_DEMAND_RUNNER_SHARED_H
#define TESTS_DEVICE_DEMAND_RUNNER_SHARED_H

#include "sluice/shared/types.h"

#define RUNNER_CHUNKS 64

#define RUNNER_GRAD 0       /* sluiceDemandGrad */
#define RUNNER_LOD 1        /* sluiceDemandLod with a[0] */
#define RUNNER_MAP 2        /* sluiceMapOrRequest of the page `index` */
#define RUNNER_BYTES 3      /* the byte page `index` of dx[0] bytes, by offsets */
#define RUNNER_ADDRESS 4    /* the byte page `index`, by its address */
#define RUNNER_LAYER_GRAD 5 /* sluiceDemandLayerGrad of layer `cell` */
#define RUNNER_LAYER_LOD 6  /* sluiceDemandLayerLod with dx[0] */
#define RUNNER_UDIM_GRAD 7  /* sluiceDemandUdimGrad */
#define RUNNER_JITTER 8     /* sluiceDemandJitter by kernel `cell`; dx[0]: dx and dy; dy: random */
#define RUNNER_CUBE_GRAD 9  /* sluiceDemandCubeGrad of cube `cell` */

struct RunnerInput {
    uint kind, index;
    float uv[2];
    float dx[2];
    float dy[2];
    uint cell;
    float direction[9]; /* RUNNER_CUBE_GRAD: direction and its derivatives */
};
SLUICE_SHARED_SIZE(struct RunnerInput, 72)

struct RunnerOutput {
    float color[4];
    uint value[2]; /* value of a page; byte pages: hash, and 0 unless unaligned */
    uint resident;
    uint reserved;
};
SLUICE_SHARED_SIZE(struct RunnerOutput, 32)

#endif
