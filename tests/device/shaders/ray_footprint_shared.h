/* One call of the functions of sluice/ray_footprint.glsl, for C and GLSL. */
#ifndef RAY_FOOTPRINT_SHARED_H
#define RAY_FOOTPRINT_SHARED_H

#if defined(__STDC_VERSION__)
#include <sluice/shared/types.h>
#else
#include "sluice/shared/types.h"
#endif

/* A path of up to two surfaces that ends on a triangle. */
#define RAY_PATH 0u
/* The change of a normal along a step, and the curvature of a triangle. */
#define RAY_NORMAL 1u

#define RAY_EVENT_NONE 0u
#define RAY_EVENT_REFLECT 1u
#define RAY_EVENT_REFRACT 2u

#define RAY_SURFACES 2u

struct RaySurface {
    float center[3]; /* center of a sphere, or normal of a plane */
    float offset;    /* offset of a plane along its normal */
    float radius;    /* 0: a plane */
    float eta;
    uint event;
    uint far; /* the ray leaves the sphere */
};
SLUICE_SHARED_SIZE(struct RaySurface, 32)
#if defined(__STDC_VERSION__)
typedef struct RaySurface RaySurface; /* GLSL names structs without the keyword */
#endif

struct RayCall {
    float origin[3], toward[3], right[3], down[3];
    float positions[9];
    float uvs[6];
    float normals[9];
    float weights[2];
    float step[3];
    float size[2];
    uint function;
    float pixelSpread; /* replaces that of the cone's first ray */
    RaySurface surfaces[RAY_SURFACES];
    float cone[4];         /* result: dx and dy */
    float differential[4]; /* result: dx and dy */
    float coneLod, coneGradientLod;
    float normalChange[3];
    float curvature;
};
SLUICE_SHARED_SIZE(struct RayCall, 300)

#endif
