/* One sample of a texture that is loaded on demand per primitive: that closest-hit shaders can. */
#version 460
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#include "demand_probe.glsl"

void main()
{
    probeDemand(gl_PrimitiveID);
}
