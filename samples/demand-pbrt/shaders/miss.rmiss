#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_GOOGLE_include_directive : require

#include "scene.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;

void main()
{
    payload.distance = -1.0;
}
