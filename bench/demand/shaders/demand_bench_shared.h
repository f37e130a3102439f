/* Shared by the host and samples.comp. */
#ifndef DEMAND_BENCH_SHARED_H
#define DEMAND_BENCH_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

#define DEMAND_BENCH_CHUNKS 64
#define DEMAND_BENCH_TEXTURES 16

#define DEMAND_BENCH_NOTHING 0 /* no sample at all */
#define DEMAND_BENCH_SAMPLED 1 /* through the demand loader */
#define DEMAND_BENCH_PLAIN 2   /* textureGrad of an ordinary image */
#define DEMAND_BENCH_BYTES 3   /* looks up byte pages, one per invocation */
#define DEMAND_BENCH_CUBIC 4   /* DEMAND_BENCH_SAMPLED in a shader with bicubic filters */
#define DEMAND_BENCH_SLOPES 5  /* with derivatives of the texture */
#define DEMAND_BENCH_KINDS 6

/* Words that shaders write for the host. */
#define DEMAND_BENCH_MISSING 0 /* samples that were not resident */
#define DEMAND_BENCH_WORDS 1

/* Samples form a square of edge x edge, divided into columns x columns fields of one texture
 * each. */
struct DemandBenchParams {
    uint edge;
    uint columns;
    uint textures[DEMAND_BENCH_TEXTURES]; /* indices */
    float textureSize;                    /* texels */
    float lod;                            /* LOD of most samples */
    float fineLod;                        /* LOD of samples in the patch around the origin */
    float fineEdge;                       /* edge of the patch in uv */
    uint firstPage, pageCount;            /* byte pages */
    uint counting;                        /* 1: count missing samples */
};

#endif
