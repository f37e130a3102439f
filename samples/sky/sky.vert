/* Draws a triangle over the whole picture, with the direction of each pixel. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sky.glsl"

layout(location = 0) out vec3 direction;

void main()
{
    vec2 at = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
    direction = view.ahead.xyz + at.x * view.right.xyz - at.y * view.up.xyz;
    gl_Position = vec4(at, 0.5, 1.0);
}
