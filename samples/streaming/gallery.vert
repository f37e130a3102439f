#version 460
#extension GL_GOOGLE_include_directive : require

#include "gallery.glsl"

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec3 inTangent;
layout(location = 3) in vec2 inUv;

layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec2 outUv;
layout(location = 2) flat out vec3 outNormal;
layout(location = 3) flat out vec3 outTangent;

void main()
{
    float m[16] = frame.viewProjection;
    mat4 viewProjection = mat4(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10],
                               m[11], m[12], m[13], m[14], m[15]);
    gl_Position = viewProjection * vec4(inPosition, 1.0);
    outPosition = inPosition;
    outUv = inUv;
    outNormal = inNormal;
    outTangent = inTangent;
}
