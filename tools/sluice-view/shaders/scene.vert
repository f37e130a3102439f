#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene_push.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv0;
layout(location = 3) in vec2 uv1;
layout(location = 0) out vec3 fragPosition;
layout(location = 1) out vec3 fragNormal;
layout(location = 2) out vec4 fragUv;

void main()
{
    fragPosition = position;
    fragNormal = normal;
    fragUv = vec4(uv0, uv1);
    gl_Position = push.viewProjection * vec4(position, 1.0);
}
