/* Takes one sample of a demand-loaded texture per fragment. */
#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "demand_probe.glsl"
#include "conform_shared.h"

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint at = pixel.y * CONFORM_TARGET_SIZE + pixel.x;
    if (at < count)
        probeDemand(at);
}
