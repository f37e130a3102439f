#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene_push.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec3 fragNormal;
layout(location = 1) out vec2 fragUv;

void main()
{
    fragNormal = normal;
    fragUv = uv;
    gl_Position = push.viewProjection * vec4(position, 1.0);
}
