/* Renders a picture of a texture whose texels are hashes, with share_texels.glsl. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/share_texels.glsl"
#include "share_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Outputs { ShareOutput outputs[]; };
layout(push_constant) uniform Push { ShareParams params; };

vec4 decodeTexel(uint key, ivec2 texel, uint level)
{
    uint h = sluiceHash(uvec3(texel, level * 2u + key));
    return vec4(h & 255u, (h >> 8u) & 255u, (h >> 16u) & 255u, h >> 24u) / 255.0;
}

/* Bits of the number, taken in turns: 4 in a row are a quad, 8 are 4x2 pixels. */
uvec2 placeInGroup(uint i)
{
    return uvec2((i & 1u) | ((i >> 1u) & 2u) | ((i >> 2u) & 4u), ((i >> 1u) & 1u) | ((i >> 2u) & 2u) | ((i >> 3u) & 4u));
}

void main()
{
    uint groups = SHARE_PICTURE / 8u, group = gl_WorkGroupID.x;
    uvec2 pixel = uvec2(group % groups, group / groups) * 8u + placeInGroup(gl_LocalInvocationIndex);
    vec2 uv = vec2(params.left, params.top) + (vec2(pixel) + 0.5) * params.step;
    uint key = (params.flags & SHARE_FLAG_MIXED) != 0u ? pixel.x & 1u : 0u;
    vec2 random = sluiceRandomPair(uvec3(pixel, params.frame));
    SluiceSharing s = sluiceBeginSharing(key, uv, params.lod, uvec2(SHARE_TEXTURE), params.levelCount,
                                         uvec2(params.modeU, params.modeV), params.kernel, random);
    vec4 own = vec4(0.0);
    if (s.decode && !s.pick.border)
        own = decodeTexel(key, s.pick.texel, s.pick.level);
    vec4 color = sluiceFinishSharing(s, own);
    uint at = pixel.y * SHARE_PICTURE + pixel.x;
    for (uint c = 0u; c < 4u; c++)
        outputs[at].color[c] = color[c];
    outputs[at].decoded = s.decode ? 1u : 0u;
    outputs[at].exact = s.exact ? 1u : 0u;
    outputs[at].level = s.pick.level;
}
