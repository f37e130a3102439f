/*
 * Faces of cube maps. Each face is a streamed texture of its own: the table index of face f is that of
 * face +X, plus f. Order and orientation are those of Vulkan ("Cube Map Face Selection").
 *
 * A position on a face is uv, 0 to 1, or beyond on the plane of the face. Samples near an edge also
 * read the face beyond: its texels continue the face as if the edge were folded flat. So the part of
 * a sample on the other face is found like that of any sample, around the unfolded position.
 */
#ifndef SLUICE_CUBE_GLSL
#define SLUICE_CUBE_GLSL

#include "footprint.glsl"

/** Sample of a face. Derivatives are those of uv per pixel. */
struct SluiceCubePoint {
    uint face;
    vec2 uv, dx, dy;
    bool finite; /* false: the direction is 0, infinite or NaN. uv is the middle of face 0 */
};

/** Returns the face that a direction hits. */
uint sluiceCubeFace(vec3 direction)
{
    vec3 length = abs(direction);
    if (length.z >= length.x && length.z >= length.y)
        return direction.z < 0.0 ? 5u : 4u;
    if (length.y >= length.x)
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
    p.uv = p.finite ? clamp(0.5 * at.xy + 0.5, 0.0, 1.0) : vec2(0.5);
    p.dx = 0.5 * (tx.xy - at.xy * tx.z);
    p.dy = 0.5 * (ty.xy - at.xy * ty.z);
    p.face = p.finite ? p.face : 0u;
    return p;
}

/** Part of a sample that lies on the face beyond an edge. */
struct SluiceCubePart {
    uint face;
    vec2 uv;      /* unfolded: may lie outside 0 to 1 */
    vec2 halfBox; /* texels of level 0 */
};

/** Returns how far a sample of levels up to `coarsest` reaches, in uv. */
vec2 sluiceCubeReach(SluiceGrid grid, vec2 halfBox, uint coarsest)
{
    vec2 levelSize = vec2(max(uvec2(grid.size) >> coarsest, 1u));
    return halfBox / grid.size + SLUICE_APRON / levelSize;
}

/** Edges: 0 and 1 at u = 0 and 1, 2 and 3 at v = 0 and 1. */
bool sluiceCrossesEdge(vec2 uv, vec2 reach, uint edge)
{
    uint axis = edge >> 1u;
    return (edge & 1u) == 0u ? uv[axis] < reach[axis] : uv[axis] + reach[axis] > 1.0;
}

/**
 * Returns the part of a sample beyond an edge.
 *
 * Seen from the middle of the cube, what is beyond the edge is narrower than unfolded, and nearer to
 * the middle of the edge. Samples of a row are there, so boxes of anisotropic samples are enlarged.
 */
SluiceCubePart sluiceUnfoldEdge(SluiceGrid grid, uint face, vec2 uv, vec2 halfBox, vec2 reach,
                                uint edge)
{
    uint axis = edge >> 1u, along = 1u - axis;
    float side = (edge & 1u) == 0u ? -1.0 : 1.0;
    vec3 outward = vec3(0.0), at = vec3(2.0 * uv - 1.0, 1.0), extent = vec3(halfBox, 0.0);
    outward[axis] = side;
    if (halfBox.x > 0.0 || halfBox.y > 0.0) {
        float beyond = 2.0 * reach[axis] + side * at[axis] - 1.0;
        extent[along] += 0.5 * grid.size[along] * beyond / (1.0 + beyond);
    }
    at.z = 2.0 - side * at[axis]; /* folded by a quarter turn around the edge */
    at[axis] = side;
    extent.z = extent[axis];
    extent[axis] = 0.0;
    SluiceCubePart part;
    part.face = sluiceCubeFace(sluiceFromFace(face, outward));
    part.uv = 0.5 * sluiceToFace(part.face, sluiceFromFace(face, at)).xy + 0.5;
    part.halfBox = abs(sluiceToFace(part.face, sluiceFromFace(face, extent)).xy);
    return part;
}

#endif
