/* Inputs and outputs of shaders that cast rays through proxy boxes. */
#ifndef TESTS_DEVICE_PROXY_RAYS_SHARED_H
#define TESTS_DEVICE_PROXY_RAYS_SHARED_H

#include "sluice/shared/types.h"

#define PROXY_RAY_MISS 0xffffffffu

struct ProxyRay {
    float origin[3], tMax;
    float direction[3], reserved;
};
SLUICE_SHARED_SIZE(struct ProxyRay, 32)

struct ProxyHit {
    float t;
    uint proxy; /* the nearest one, or PROXY_RAY_MISS */
    uint face;
    float normal[3];
};
SLUICE_SHARED_SIZE(struct ProxyHit, 24)

struct ProxyRayParams {
    uint rayCount, boxCount;
    uint firstGeometry, firstMaterial; /* pages */
    uint through; /* not 0: rays go through all boxes, and request the material of each */
};
SLUICE_SHARED_SIZE(struct ProxyRayParams, 20)

#endif
