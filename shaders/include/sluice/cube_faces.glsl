/*
 * Finds the face of a cube map that a direction hits, and the position on the face. Faces have Vulkan's
 * order and orientation ("Cube Map Face Selection"). A position is uv on the plane of the face, 0 to 1
 * within the face. Pure functions: no definitions are necessary.
 */
#ifndef SLUICE_CUBE_FACES_GLSL
#define SLUICE_CUBE_FACES_GLSL

#include "language.glsl"

/** Sample of a face. Derivatives: uv per pixel. */
struct SluiceCubePoint {
    uint face;
    vec2 uv, dx, dy;
    bool finite; /* false: the direction is 0, infinite or NaN. uv is the middle of face 0 */
};

/** Returns the face that a direction hits. */
uint sluiceCubeFace(vec3 direction)
{
    vec3 extent = abs(direction);
    if (extent.z >= extent.x && extent.z >= extent.y)
        return direction.z < 0.0 ? 5u : 4u;
    if (extent.y >= extent.x)
        return direction.y < 0.0 ? 3u : 2u;
    return direction.x < 0.0 ? 1u : 0u;
}

/** Turns a vector so that x and y are along u and v of a face, and z points out of the cube. */
vec3 sluiceToFace(uint face, vec3 v)
{
    float side = (face & 1u) == 0u ? 1.0 : -1.0;
    if (face < 2u)
        return vec3(-side * v.z, -v.y, side * v.x);
    if (face < 4u)
        return vec3(v.x, side * v.z, side * v.y);
    return vec3(side * v.x, -v.y, side * v.z);
}

/** Inverts sluiceToFace. */
vec3 sluiceFromFace(uint face, vec3 v)
{
    float side = (face & 1u) == 0u ? 1.0 : -1.0;
    if (face < 2u)
        return vec3(side * v.z, -v.y, -side * v.x);
    if (face < 4u)
        return vec3(v.x, side * v.z, side * v.y);
    return vec3(side * v.x, -v.y, side * v.z);
}

/** Returns the direction of a position on a face. */
vec3 sluiceCubeDirection(uint face, vec2 uv)
{
    return sluiceFromFace(face, vec3(2.0 * uv - 1.0, 1.0));
}

/**
 * Returns the position on the face beyond an edge, and replaces `face` by that face. `uv` is beyond one
 * edge of `face`, less than a face away: the edge is folded flat.
 */
vec2 sluiceFoldOverEdge(inout uint face, vec2 uv)
{
    vec3 at = vec3(2.0 * uv - 1.0, 1.0), outward = SLUICE_SPLAT(vec3, 0.0);
    uint axis = abs(at.x) > 1.0 ? 0u : 1u;
    float side = at[axis] < 0.0 ? -1.0 : 1.0;
    outward[axis] = side;
    at.z = 2.0 - side * at[axis]; /* folded by a quarter turn around the edge */
    at[axis] = side;
    uint next = sluiceCubeFace(sluiceFromFace(face, outward));
    at = sluiceToFace(next, sluiceFromFace(face, at));
    face = next;
    return 0.5 * at.xy + 0.5;
}

/** Returns the position of a direction with derivatives. */
SluiceCubePoint sluiceFindCubePoint(vec3 direction, vec3 dx, vec3 dy)
{
    SluiceCubePoint p;
    p.face = sluiceCubeFace(direction);
    vec3 at = sluiceToFace(p.face, direction);
    /* divided first, because products of long vectors leave the range of float */
    vec3 tx = sluiceToFace(p.face, dx) / at.z, ty = sluiceToFace(p.face, dy) / at.z;
    at.xy /= at.z;
    /* false for NaN. On an edge the quotient may be rounded to more than 1. */
    p.finite = abs(at.x) <= 1.001 && abs(at.y) <= 1.001 && at.z <= 1.0e33;
    p.uv = p.finite ? clamp(0.5 * at.xy + 0.5, 0.0, 1.0) : SLUICE_SPLAT(vec2, 0.5);
    p.dx = 0.5 * (tx.xy - at.xy * tx.z);
    p.dy = 0.5 * (ty.xy - at.xy * ty.z);
    p.face = p.finite ? p.face : 0u;
    return p;
}

#endif
