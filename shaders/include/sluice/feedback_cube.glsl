/*
 * Records the levels that samples of cube maps want, like feedback.glsl, on every face that a sample
 * touches.
 *
 * `tableIndex` is SluiceVulkanTexture.tableIndex of the first face of the cube. Derivatives are those
 * of the direction per pixel. The direction need not have length 1.
 *
 * Include it after the definitions of buffers.glsl and feedback.glsl.
 */
#ifndef SLUICE_FEEDBACK_CUBE_GLSL
#define SLUICE_FEEDBACK_CUBE_GLSL

#include "language.glsl"
#ifndef SLUICE_HLSL
#extension GL_EXT_control_flow_attributes : require
#endif

#include "cube.glsl"
#include "feedback.glsl"

/** Marks the box of a sample of `level` to `coarsest` on the face beyond an edge if it crosses that edge. */
void sluiceMarkBeyondEdge(uint tableIndex, SluiceGrid grid, SluiceCubePoint p, vec2 halfBox, uint level,
                          uint coarsest, uint edge)
{
    vec2 reach = sluiceCubeReach(grid, halfBox, coarsest);
    if (!sluiceCrossesEdge(p.uv, reach, edge))
        return;
    SluiceCubePart part = sluiceUnfoldEdge(grid, p.face, p.uv, halfBox, reach, edge);
    if (sluiceTakesPart(tableIndex + part.face))
        sluiceMarkFootprint(SLUICE_TEXTURE_ENTRY(tableIndex + part.face).feedbackOffset, grid,
                            sluiceComputeFootprint(grid, part.uv, part.halfBox, coarsest), level);
}

/** Marks the box of a sample of `level` to `coarsest` on the faces beyond the edges that it crosses. */
void sluiceMarkBeyondEdges(uint tableIndex, SluiceGrid grid, SluiceCubePoint p, vec2 halfBox, uint level,
                           uint coarsest)
{
    SLUICE_DONT_UNROLL for (uint edge = 0u; edge < 4u; edge++)
        sluiceMarkBeyondEdge(tableIndex, grid, p, halfBox, level, coarsest, edge);
}

/**
 * Marks every region that a sample of a cube map touches, on all faces, with the finest level that it
 * may touch there.
 *
 * Pass LOD bias and anisotropy of the sample (1: none). If the direction is 0 or not finite, only the
 * coarsest level of one face is marked.
 */
void sluiceWriteCubeFeedback(uint tableIndex, vec3 direction, vec3 dx, vec3 dy, float lodBias,
                             float maxAnisotropy)
{
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    SluiceCubePoint p = sluiceFindCubePoint(direction, dx, dy);
    if (!p.finite) {
        sluiceWriteFeedbackLod(tableIndex, p.uv, SLUICE_LOD_LIMIT);
        return;
    }
    vec2 tx = p.dx * grid.size, ty = p.dy * grid.size;
    uvec3 levels = sluiceMarkedLevels(grid, p.uv, tx, ty, lodBias, maxAnisotropy);
    if (sluiceTakesPart(tableIndex + p.face))
        sluiceMarkSample(tableIndex + p.face, grid, p.uv, tx, ty, lodBias, maxAnisotropy, levels.x,
                         levels.y, levels.z);
    vec2 halfBox = sluiceHalfBox(tx, ty, lodBias, maxAnisotropy);
    sluiceMarkBeyondEdges(tableIndex, grid, p, halfBox, levels.x, levels.y);
    if (maxAnisotropy > 1.0 && levels.z > levels.y)
        sluiceMarkBeyondEdges(tableIndex, grid, p, halfBox, levels.y + 1u, levels.z);
}

/**
 * Writes feedback like sluiceWriteCubeFeedback, for 2x2 quads whose pixels are selected together. Each
 * pixel marks another corner of its footprint on its own face, and what lies beyond another edge of it.
 *
 * `pixel` selects corner and edge. The two low bits of `frameSeed` rotate both: see
 * sluiceWriteQuadFeedback. What only one pixel reaches is marked in one of four frames that select it.
 */
void sluiceWriteCubeQuadFeedback(uint tableIndex, vec3 direction, vec3 dx, vec3 dy, float lodBias,
                                 float maxAnisotropy, uvec2 pixel, uint frameSeed)
{
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    SluiceCubePoint p = sluiceFindCubePoint(direction, dx, dy);
    if (!p.finite) {
        sluiceWriteFeedbackLod(tableIndex, p.uv, SLUICE_LOD_LIMIT);
        return;
    }
    sluiceWriteQuadFeedback(tableIndex + p.face, p.uv, p.dx, p.dy, lodBias, maxAnisotropy, pixel,
                            frameSeed);
    vec2 tx = p.dx * grid.size, ty = p.dy * grid.size;
    uvec3 levels = sluiceMarkedLevels(grid, p.uv, tx, ty, lodBias, maxAnisotropy);
    vec2 halfBox = sluiceHalfBox(tx, ty, lodBias, maxAnisotropy);
    uvec2 corner = (pixel ^ uvec2(frameSeed, frameSeed >> 1u)) & 1u;
    uint edge = corner.x | corner.y << 1u;
    sluiceMarkBeyondEdge(tableIndex, grid, p, halfBox, levels.x, levels.y, edge);
    if (maxAnisotropy > 1.0 && levels.z > levels.y)
        sluiceMarkBeyondEdge(tableIndex, grid, p, halfBox, levels.y + 1u, levels.z, edge);
}

/**
 * Marks what textureLod of a cube map touches: the level is `lod`, without anisotropy. NaN marks the
 * coarsest level.
 */
void sluiceWriteCubeFeedbackLod(uint tableIndex, vec3 direction, float lod)
{
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    SluiceCubePoint p = sluiceFindCubePoint(direction, SLUICE_SPLAT(vec3, 0.0), SLUICE_SPLAT(vec3, 0.0));
    lod = p.finite ? sluiceClampLod(lod) : SLUICE_LOD_LIMIT;
    uint count = sluiceMipCount(grid);
    sluiceWriteFeedbackLod(tableIndex + p.face, p.uv, lod);
    sluiceMarkBeyondEdges(tableIndex, grid, p, SLUICE_SPLAT(vec2, 0.0), sluiceFinestLevel(lod, 0.0, count),
                          sluiceCoarsestLevel(lod, count));
}

#endif
