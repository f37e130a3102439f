#version 450
#extension GL_GOOGLE_include_directive : require
#include "bindless.glsl"

layout(local_size_x = BINDLESS_GROUP, local_size_y = BINDLESS_GROUP) in;

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uint choice = chosen(pixel);
    uint at = params.only != BINDLESS_NO_TEXTURE ? params.only : choice;
    uint index = textures[at].tableIndex, missing;
    float scale = textures[at].scale, anisotropy = textures[at].maxAnisotropy;
    vec2 uv = place(vec2(pixel), scale);
    vec2 dx = place(vec2(pixel) + vec2(1.0, 0.0), scale) - uv;
    vec2 dy = place(vec2(pixel) + vec2(0.0, 1.0), scale) - uv;
    vec4 color = sluiceSampleGrad(TEXTURE, index, uv, dx, dy, 0.0, anisotropy, missing);
    vec4 texel = sluiceTexelFetch(TEXTURE, index, ivec2(0), textures[at].lastLevel);
    if (at == choice)
        store(pixel, choice, color, texel, missing);
#ifndef BINDLESS_ALONE
    sluiceWriteFeedback(index, uv, dx, dy, 0.0, anisotropy);
#endif
}
