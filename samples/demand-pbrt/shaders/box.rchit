/* Runs if a box is the nearest hit. */
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_GOOGLE_include_directive : require

#include "demand.glsl"
#include "scene.glsl"
#include "box.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;

void main()
{
    meetBox(payload, gl_PrimitiveID, gl_HitTEXT, gl_HitKindEXT);
}
