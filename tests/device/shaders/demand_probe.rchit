/* Takes one sample of a demand-loaded texture per primitive, in a closest-hit shader. */
#version 460
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#include "demand_probe.glsl"

void main()
{
    probeDemand(gl_PrimitiveID);
}
