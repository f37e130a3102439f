/* Structs and numbers that the host code and the shaders of demand-tracer share. */
#ifndef TRACER_SHARED_H
#define TRACER_SHARED_H

#include "sluice/shared/types.h"

#define TRACER_PAGE_CAPACITY 0x04000000u /* pageCapacity */

/* Descriptor set 1. Set 0 is the demand loader's. */
#define TRACER_BINDING_VERTICES 0
#define TRACER_BINDING_INDICES 1
#define TRACER_BINDING_INSTANCES 2
#define TRACER_BINDING_NODES 3
#define TRACER_BINDING_FILM 4
#define TRACER_BINDING_LATEST 5
#define TRACER_BINDING_LISTS 6
#define TRACER_BINDING_COUNTERS 7
#define TRACER_BINDING_NEEDS 8
#define TRACER_OWN_BUFFERS 9
#define TRACER_BINDING_SCENE 9 /* acceleration structure; ray-tracing pipelines only */

/* Specialization constants */
#define TRACER_CONSTANT_PREVIEW 0
#define TRACER_CONSTANT_NEEDS 1
#define TRACER_CONSTANT_SCENE_ROOT 2 /* compute path only */

#define TRACER_ROW_WIDTH 1024 /* rays of one row of a launch */
#define TRACER_GROUP_SIZE 64  /* threads of the compute path */
#define TRACER_MAX_BOUNCES 8

struct TracerVertex {
    float position[3]; /* in the shape's own space */
    float normal[3];   /* outward, length 1 */
    float uv[2];
};
SLUICE_SHARED_SIZE(struct TracerVertex, 32)

/* TracerInstance.flags */
#define TRACER_CUT_OUT 1u /* holes where alpha is below one half; light shines through */
#define TRACER_GLOSSY 2u

struct TracerInstance {
    float toWorld[12];  /* three rows of four */
    float toObject[12]; /* its inverse */
    uint firstIndex;    /* first index of the shape's triangles */
    uint rootNode;      /* root of the shape's tree */
    uint texture;       /* index for sluice/demand.glsl */
    uint flags;
};
SLUICE_SHARED_SIZE(struct TracerInstance, 112)

/* A box around two nodes, `first` and `first` + 1, or around `count` triangles or instances. */
struct TracerNode {
    float low[3];
    uint first;
    float high[3];
    uint count; /* 0: the box is around nodes */
};
SLUICE_SHARED_SIZE(struct TracerNode, 32)

/* Push constants of one launch. */
struct TracerLaunch {
    uint width, height; /* pixels */
    uint count;         /* pixels to trace: the first `count` in the list */
    uint sampleIndex;
    float eye[3];
    float spread;   /* radians per pixel */
    float right[3]; /* half of the picture's width at distance 1 */
    uint seed;
    float up[3];
    uint bounces;
    float forward[3]; /* length 1 */
    uint listIndex;   /* 0 or 1: the list to read; the other one is written */
};
SLUICE_SHARED_SIZE(struct TracerLaunch, 80)

#endif
