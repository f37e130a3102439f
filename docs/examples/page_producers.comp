/* Lines that docs/producers.md shows. */
#version 450

struct ShaderTile {
    uint level, x, y, width, height, targetX, targetY, layer;
};
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba8) writeonly uniform image2DArray target;
layout(std430, binding = 1) readonly buffer Tiles { ShaderTile tiles[]; };
layout(push_constant) uniform Push { uint first; };

vec4 terrainColor(vec2 place) /* of texel centers, in texels of level 0 */
{
    return vec4(fract(place / 4096.0), 0.5, 1.0);
}

void main()
{
    ShaderTile tile = tiles[first + gl_GlobalInvocationID.z];
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= tile.width || at.y >= tile.height)
        return;
    vec2 place = (vec2(uvec2(tile.x, tile.y) + at) + 0.5) * exp2(float(tile.level));
    imageStore(target, ivec3(tile.targetX + at.x, tile.targetY + at.y, tile.layer),
               terrainColor(place));
}
