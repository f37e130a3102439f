/* Writes the feedback of one sample per quad, from its first fragment. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "conform.glsl"

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uvec2 quad = pixel >> 1u;
    uvec2 lane = pixel & 1u;
    uint at = quad.y * (CONFORM_TARGET_SIZE / 2u) + quad.x;
    bool inside = at < count;
    at = min(at, count - 1u); /* derivatives need all four */
    vec2 uv = inputUv(at);
    vec2 dx = inputDx(at);
    vec2 dy = inputDy(at);
    if (inputs[at].mode == CONFORM_IMPLICIT) {
        vec2 here = uv + float(lane.x) * dx + float(lane.y) * dy;
        dx = dFdxFine(here);
        dy = dFdyFine(here);
    }
    if (inside && lane == uvec2(0u))
        writeSample(at, uv, dx, dy);
}
