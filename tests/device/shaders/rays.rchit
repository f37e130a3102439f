/* Feedback with the footprint of a ray cone: as wide as the angle times the distance. */
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#include "writer.glsl"

layout(location = 0) rayPayloadInEXT uint tableIndex;

void main()
{
    vec2 uv = (gl_WorldRayOriginEXT + gl_WorldRayDirectionEXT * gl_HitTEXT).xy;
    float width = params.coneAngle * gl_HitTEXT; /* the ray is at a right angle to the floor */
    sluiceWriteFeedback(tableIndex, uv, vec2(width, 0.0), vec2(0.0, width), 0.0, 1.0);
}
