/* Shared by the shaders of the benchmarks and the host. */
#ifndef BENCH_SHARED_H
#define BENCH_SHARED_H

#include "sluice/shared/types.h"

#define BENCH_PAGE_CHUNKS 64

/* Specialization constants. */
#define BENCH_CONSTANT_STREAMED 0 /* 0: an ordinary texture and texture() */
#define BENCH_CONSTANT_SCENE 1
#define BENCH_CONSTANT_FEEDBACK 2
#define BENCH_CONSTANT_ANISOTROPY 3 /* anisotropy of the sampler; 1: none */
#define BENCH_CONSTANT_COUNTING 4   /* counts sharp regions instead of drawing */
#define BENCH_CONSTANT_COUNT 5

#define BENCH_SCENE_FLOOR 0    /* a plane up to the horizon */
#define BENCH_SCENE_CLOSE_UP 1 /* a few regions fill the screen */
#define BENCH_SCENE_NOISE 2    /* a random position per 4x4 pixels */

#define BENCH_FEEDBACK_NONE 0
#define BENCH_FEEDBACK_QUADS 1 /* quads of pixels at random */
#define BENCH_FEEDBACK_LATTICE 2
#define BENCH_FEEDBACK_ALL 3    /* every pixel */
#define BENCH_FEEDBACK_BLOCKS 4 /* one block of 4x4 pixels in 16x16 */

/* wants.comp: the level that each region requests, one thread per region. */
#define BENCH_WANTS_PATCH 0  /* level, and one finer within patch[] regions from the origin */
#define BENCH_WANTS_RANDOM 1 /* level, or with the given probability one coarser */
#define BENCH_WANTS_VIEW 2   /* levels for a camera over textures side by side on a floor */
#define BENCH_WANTS_COUNT 3  /* requests nothing; counts missing levels for PATCH */

/* Words of the output buffer after BENCH_WANTS_COUNT. */
#define BENCH_COUNT_SAMPLES 0
#define BENCH_COUNT_NOTHING 1 /* samples without even packed levels */
#define BENCH_COUNT_COARSER 2
#define BENCH_COUNT_LEVELS 3 /* sum of the levels that samples lack */
#define BENCH_COUNT_WORDS 4

struct BenchParams {
    uint width; /* width of the picture; wants.comp: of a feedback map */
    uint height;
    uint textureCount;
    uint kind;
    uint level;
    uint seed;
    float probability;
    float cameraAngle;
    float camera[2]; /* meters */
    float textureSize[2];
    uint patchSize[2]; /* regions */
    uint tableIndex;   /* table index of the scene's texture */
};
SLUICE_SHARED_SIZE(struct BenchParams, 60)

#define BENCH_MAKE_GROUP 8

/* make.comp: texels that a tile producer writes. */
struct BenchTile {
    uint level;
    uint x; /* position in the texture's level */
    uint y;
    uint width;
    uint height;
    uint targetX;
    uint targetY;
    uint layer;
};
SLUICE_SHARED_SIZE(struct BenchTile, 32)

struct BenchMake {
    uint firstTile;
    uint steps; /* per texel */
};
SLUICE_SHARED_SIZE(struct BenchMake, 8)

#endif
