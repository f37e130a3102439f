#version 450
#extension GL_GOOGLE_include_directive : require
#include "bindless.glsl"

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint choice = chosen(pixel);
    uint at = params.only != BINDLESS_NO_TEXTURE ? params.only : choice;
    uint index = textures[at].tableIndex, missing;
    float anisotropy = textures[at].maxAnisotropy;
    vec2 uv = place(vec2(pixel), textures[0].scale); /* the derivatives are those of the quad */
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    vec4 color = sluiceSample(TEXTURE, index, uv, 0.0, anisotropy, missing);
    vec4 texel = sluiceTexelFetch(TEXTURE, index, ivec2(0), textures[at].lastLevel);
    if (at == choice)
        store(pixel, choice, color, texel, missing);
#ifndef BINDLESS_ALONE
    sluiceWriteFeedback(index, uv, dx, dy, 0.0, anisotropy);
#endif
}
