/* The lines that demand.md shows about grids, compiled as they are there. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_DEMAND_SET 0
#include "sluice/demand_bindings.glsl"
#include "sluice/demand_grids.glsl"

layout(std430, set = 1, binding = 0) buffer Answer { vec4 colors[]; } answer;
layout(push_constant) uniform Draw { uint index; } draw;
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uint grid = draw.index;
    vec2 uv = vec2(gl_GlobalInvocationID.xy) / 64.0, dx = vec2(0.01, 0.0), dy = vec2(0.0, 0.01);
    bool resident;
    vec4 color = sluiceDemandUdimGrad(grid, uv, dx, dy, resident); /* uv in cells */
    answer.colors[0] = color;
}
