/* Makes tiles: one dispatch, whose groups in z are tiles. `steps` says how dear a texel is. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "bench_shared.h"

layout(local_size_x = BENCH_MAKE_GROUP, local_size_y = BENCH_MAKE_GROUP) in;
layout(binding = 0, rgba8) writeonly uniform image2DArray target;
layout(std430, binding = 1) readonly buffer Tiles { BenchTile tiles[]; };
layout(push_constant) uniform Push { BenchMake make; };

void main()
{
    BenchTile tile = tiles[make.firstTile + gl_GlobalInvocationID.z];
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= tile.width || at.y >= tile.height)
        return;
    uint value = (tile.x + at.x) * 0x9E3779B9u ^ (tile.y + at.y) * 0x85EBCA6Bu ^ tile.level;
    for (uint i = 0u; i < make.steps; i++)
        value = value * 1664525u + (value >> 15u) + 1013904223u;
    imageStore(target, ivec3(tile.targetX + at.x, tile.targetY + at.y, tile.layer),
               unpackUnorm4x8(value));
}
