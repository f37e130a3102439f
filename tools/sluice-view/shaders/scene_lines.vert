#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene_push.glsl"

layout(location = 0) in vec3 position;

/* Moves lines slightly in front of the triangles, so that triangles do not hide their edges. */
void main()
{
    gl_Position = push.viewProjection * vec4(mix(position, push.eye, 0.003), 1.0);
}
