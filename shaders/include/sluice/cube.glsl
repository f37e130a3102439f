/*
 * Samples of streamed cube maps. Each face is a streamed texture of its own: the table index of face f
 * is that of face +X, plus f.
 *
 * Samples near an edge also read the face beyond: its texels continue the face as if the edge were
 * folded flat. So the part of a sample on the other face is found like that of any sample, around the
 * unfolded position.
 */
#ifndef SLUICE_CUBE_GLSL
#define SLUICE_CUBE_GLSL

#include "cube_faces.glsl"
#include "footprint.glsl"

/** Part of a sample that lies on the face beyond an edge. */
struct SluiceCubePart {
    uint face;
    vec2 uv;      /* unfolded: may lie outside 0 to 1 */
    vec2 halfBox; /* texels of level 0 */
};

/** Returns how far a sample of levels up to `coarsest` reaches, in uv. */
vec2 sluiceCubeReach(SluiceGrid grid, vec2 halfBox, uint coarsest)
{
    vec2 levelSize = vec2(max(uvec2(grid.size) >> coarsest, SLUICE_SPLAT(uvec2, 1u)));
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
    vec3 outward = SLUICE_SPLAT(vec3, 0.0), at = vec3(2.0 * uv - 1.0, 1.0), extent = vec3(halfBox, 0.0);
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
