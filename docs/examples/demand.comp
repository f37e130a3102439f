/* Samples 256 x 256 places of four textures, at full detail, and counts what is missing. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_DEMAND_SET 0
#include "sluice/demand_bindings.glsl"
#include "sluice/demand.glsl"

layout(std430, set = 1, binding = 0) buffer Answer { uint missing; vec4 color; uint indices[4]; } answer;
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    uint index = answer.indices[(at.x / 8u + at.y / 8u) % 4u];
    vec2 uv = vec2(0.25, 0.75) + vec2(at) / 8192.0;
    vec2 dx = vec2(1.0 / 8192.0, 0.0), dy = dx.yx; /* one pixel is one texel */
    bool resident;
    vec4 color = sluiceDemandGrad(index, uv, dx, dy, resident);
    if (!resident)
        atomicAdd(answer.missing, 1u);
    if (at == uvec2(0u))
        answer.color = color;
}
