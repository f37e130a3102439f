/* The lines that images.md shows about cube maps in demand loading, compiled as they are there. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_DEMAND_SET 0
#include "sluice/demand_bindings.glsl"
#include "sluice/demand_cubes.glsl"

layout(std430, set = 1, binding = 0) buffer Answer { vec4 colors[]; } answer;
layout(push_constant) uniform Draw { uint index; } draw;
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uint grid = draw.index, cube = 0u;
    vec3 direction = vec3(gl_GlobalInvocationID), dx = vec3(0.01, 0.0, 0.0), dy = vec3(0.0, 0.01, 0.0);
    bool resident;
    vec4 color = sluiceDemandCubeGrad(grid, cube, direction, dx, dy, resident); /* derivatives of the direction */
    answer.colors[0] = color;
}
