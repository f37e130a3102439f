/*
 * Proxies of geometry and materials: boxes that rays hit, and requests for what they stand for.
 * include/sluice/proxy.h has the host's side, docs/proxies.md an example.
 *
 * Include demand_bindings.glsl before this file, or define the macros of demand_pages.glsl. Any
 * stage: intersection, any-hit, closest-hit, compute. Pass `firstPage` of sluiceAddDemandProxies
 * as you pass other constants.
 */
#ifndef SLUICE_PROXY_GLSL
#define SLUICE_PROXY_GLSL

#include "demand_pages.glsl"

/**
 * Requests a proxy of geometry. `proxy` is its index: gl_PrimitiveID, if the boxes are the
 * primitives of the structure. Thousands of invocations may request the same proxy.
 */
void sluiceRequestGeometryProxy(uint firstPage, uint proxy)
{
    sluiceRequestDemandPage(firstPage + proxy);
}

/** Requests a proxy of a material. `proxy` is its index. */
void sluiceRequestMaterialProxy(uint firstPage, uint proxy)
{
    sluiceRequestDemandPage(firstPage + proxy);
}

/**
 * Intersects a ray with a box. Returns true if the ray is inside of the box somewhere between tMin
 * and tMax. Then `t` is where it enters, at least tMin: an origin inside of the box is a hit at
 * tMin. `face` is the face that it enters through; inside, the face that it leaves through. Faces
 * are 0 to 5: -x, +x, -y, +y, -z, +z.
 *
 * A box of size 0 is never hit. Rounding never makes a ray miss a box that it hits; a box may seem larger by 1e-6 of the
 * distance. `direction` need not have length 1 and may have components of 0.
 */
bool sluiceIntersectProxyBox(vec3 boxMin, vec3 boxMax, vec3 origin, vec3 direction, float tMin,
                             float tMax, out float t, out uint face)
{
    const float LARGEST = 3.4e38;
    float enter = -LARGEST, leave = LARGEST;
    uint enterFace = 0u, leaveFace = 0u;
    bool hit = all(lessThan(boxMin, boxMax)); /* removed proxies have boxes of size 0 */
    for (int axis = 0; axis < 3; axis++) {
        float toMin = boxMin[axis] - origin[axis], toMax = boxMax[axis] - origin[axis];
        if (abs(direction[axis]) < 1e-37) { /* parallel: inside of the slab, or never */
            hit = hit && toMin <= 0.0 && toMax >= 0.0;
            continue;
        }
        bool up = direction[axis] > 0.0;
        float near = clamp((up ? toMin : toMax) / direction[axis], -LARGEST, LARGEST);
        float far = clamp((up ? toMax : toMin) / direction[axis], -LARGEST, LARGEST);
        far += abs(far) * 1e-6; /* two subtractions and two divisions of 2.5 ULP: 7.2e-7 at most */
        uint lower = 2u * uint(axis), upper = lower + 1u;
        if (near > enter) {
            enter = near;
            enterFace = up ? lower : upper;
        }
        if (far < leave) {
            leave = far;
            leaveFace = up ? upper : lower;
        }
    }
    bool inside = enter < tMin;
    t = max(enter, tMin);
    face = inside ? leaveFace : enterFace;
    return hit && t <= min(leave, tMax);
}

/** The normal of a face, outward. */
vec3 sluiceProxyFaceNormal(uint face)
{
    vec3 normal = SLUICE_SPLAT(vec3, 0.0);
    normal[face / 2u] = (face & 1u) != 0u ? 1.0 : -1.0;
    return normal;
}

#endif
