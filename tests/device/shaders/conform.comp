/* Writes the feedback of one sample per invocation. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "conform.glsl"

layout(local_size_x = 64) in;

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at < count)
        writeSample(at, inputUv(at), inputDx(at), inputDy(at));
}
