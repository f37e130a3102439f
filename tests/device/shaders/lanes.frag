/* Marks the region of each fragment's pixel. The attachment shows which fragments existed. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "conform.glsl"
#include "sluice/stochastic.glsl"

layout(location = 0) out float covered;

void main()
{
    vec2 uv = gl_FragCoord.xy / float(CONFORM_TARGET_SIZE);
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    /* `count` is no count here: which fragments leave before they write, becoming helpers */
    if (count != 0u && sluiceHash(uvec3(gl_FragCoord.xy, count)) % 3u == 0u)
        discard;
    covered = 1.0;
    /* a quarter of a texel per pixel, so that only the region of this pixel is in the footprint */
    sluiceWriteFeedback(0u, uv, dx / 256.0, dy / 256.0, 0.0, 1.0);
}
