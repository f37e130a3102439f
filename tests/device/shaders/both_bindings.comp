/* Compiles only if one shader can use the sets of a frame and of a launch. Never run. */
#version 450
#extension GL_GOOGLE_include_directive : require
#define SLUICE_SET 0
#define SLUICE_DEMAND_SET 1
#define SLUICE_PAGED true
#include "sluice/bindings.glsl"
#include "sluice/demand_bindings.glsl"
#include "sluice/demand.glsl"
#include "sluice/sample.glsl"

layout(local_size_x = 1) in;
layout(set = 2, binding = 0) uniform sampler2D image;
layout(set = 2, binding = 1) writeonly buffer Colors
{
    vec4 colors[];
};

void main()
{
    bool resident;
    uint missing;
    colors[0] = sluiceDemandLod(0u, vec2(0.5), 0.0, resident);
    colors[1] = sluiceSampleGrad(image, 0u, vec2(0.5), vec2(0.0), vec2(0.0), 0.0, 1.0, missing);
    /* The arrays differ: naming both is an error if one is left out. */
    colors[2] = texelFetch(sluicePages[0], ivec3(0), 0) + texelFetch(sluiceDemandPages[0], ivec3(0), 0);
}
