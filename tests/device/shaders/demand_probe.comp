/* Takes one sample of a demand-loaded texture per invocation. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "demand_probe.glsl"

layout(local_size_x = 64) in;

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at < count)
        probeDemand(at);
}
