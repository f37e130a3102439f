/* Slivers and specks of triangles, whose quads are hardly ever covered as a whole. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/stochastic.glsl"

float draw(uint a, uint b)
{
    return float(sluiceHash(uvec3(a, b, 5u)) >> 8u) / 16777216.0;
}

void main()
{
    uint triangle = uint(gl_VertexIndex) / 3u;
    uint corner = uint(gl_VertexIndex) % 3u;
    vec2 at = vec2(draw(triangle, 10u), draw(triangle, 11u)) * 2.0 - 1.0;
    float size = triangle % 3u == 0u ? 0.7 : 0.04;
    gl_Position = vec4(at + size * (vec2(draw(triangle, corner), draw(triangle, corner + 3u)) - 0.5),
                       0.0, 1.0);
}
