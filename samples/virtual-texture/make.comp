/* Makes the tiles of a batch: one dispatch, whose groups in z are tiles. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "fractal_shared.h"
#include "fractal.glsl"

layout(local_size_x = FRACTAL_GROUP, local_size_y = FRACTAL_GROUP) in;
layout(binding = 0, r8) writeonly uniform image2DArray target;
layout(std430, binding = 1) readonly buffer Tiles { FractalTile tiles[]; };
layout(push_constant) uniform Push { FractalMake make; };

void main()
{
    FractalTile tile = tiles[make.firstTile + gl_GlobalInvocationID.z];
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= tile.width || at.y >= tile.height)
        return;
    uint steps = fractalSteps(make.sizeLog2 - tile.level, uvec2(tile.x, tile.y) + at);
    imageStore(target, ivec3(tile.targetX + at.x, tile.targetY + at.y, tile.layer),
               vec4(float(steps) / 255.0));
}
