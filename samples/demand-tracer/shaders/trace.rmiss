#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "rays.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;

void main()
{
    payload.surface.distance = -1.0;
}
