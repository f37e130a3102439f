/* Runs if a surface is the nearest hit. */
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_GOOGLE_include_directive : require

#include "demand.glsl"
#include "scene.glsl"
#include "hit.glsl"
#include "programs.glsl"
#include "alpha.glsl"
#include "rays.glsl"

void main()
{
    meetTriangle(meetingHere(), false);
}
