/* Writes the texels of PATTERN_HASH (pattern.c) to tiles of one image. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "maker_shared.h"

layout(local_size_x = MAKER_GROUP, local_size_y = MAKER_GROUP) in;
layout(binding = 0, rgba8) writeonly uniform image2DArray target;
layout(std430, binding = 1) readonly buffer Tiles { MakerTile tiles[]; };
layout(push_constant) uniform Push { uint first; };

uint mixBits(uint level, uint x, uint y, uint channel)
{
    uint h = x * 0x9E3779B1u ^ y * 0x85EBCA77u ^ level * 0xC2B2AE3Du ^ channel * 0x27D4EB2Fu;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    return h ^ h >> 15;
}

void main()
{
    MakerTile tile = tiles[first + gl_GlobalInvocationID.z];
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= tile.width || at.y >= tile.height)
        return;
    vec4 color;
    for (uint channel = 0u; channel < 4u; channel++)
        color[channel] =
            float(mixBits(tile.level, tile.x + at.x, tile.y + at.y, channel) & 255u) / 255.0;
    imageStore(target, ivec3(tile.targetX + at.x, tile.targetY + at.y, tile.layer), color);
}
