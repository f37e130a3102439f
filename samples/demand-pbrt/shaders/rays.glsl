/* Inputs of the pipeline's hit stages at a triangle. */
#ifndef PBRT_RAYS_GLSL
#define PBRT_RAYS_GLSL

layout(location = 0) rayPayloadInEXT Payload payload;
hitAttributeEXT vec2 weights;

#include "surface.glsl"

Meeting meetingHere()
{
    return Meeting(gl_InstanceCustomIndexEXT, gl_PrimitiveID, weights, gl_HitTEXT,
                   gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT, gl_ObjectToWorldEXT,
                   gl_WorldToObjectEXT);
}

#endif
