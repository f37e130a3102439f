/* Samples the textures of the nearest surface. */
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "rays.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;
hitAttributeEXT vec2 weights;

void main()
{
    bool complete = payload.surface.complete;
    noting = payload.noting;
    payload.surface = surfaceAt(gl_InstanceID, gl_PrimitiveID, weights, gl_WorldRayDirectionEXT,
                                gl_HitTEXT, payload.cone);
    payload.surface.complete = payload.surface.complete && complete;
}
