/* The lines that docs/sampling.md shows, compiled as they are there. */
#version 450
#extension GL_GOOGLE_include_directive : require

#define SLUICE_DEMAND_CUBIC true
#include "sluice/demand_bindings.glsl"
#include "sluice/demand.glsl"

layout(std430, set = 1, binding = 0) buffer Answer { vec4 colors[]; } answer;
layout(push_constant) uniform Draw { uint index; } draw;
layout(local_size_x = 8, local_size_y = 8) in;

vec3 bumpNormal(uint index, vec2 uv, vec2 dx, vec2 dy, float height, vec3 tangent, vec3 bitangent, vec3 normal)
{
    vec4 du, dv;
    bool resident;
    vec4 color = sluiceDemandDerivatives(index, uv, dx, dy, du, dv, resident);
    /* tangent and bitangent: the change of position per unit of u and v */
    vec3 alongU = tangent + height * du.r * normal, alongV = bitangent + height * dv.r * normal;
    return normalize(cross(alongU, alongV));
}

void main()
{
    vec3 normal = bumpNormal(draw.index, vec2(0.5), vec2(0.01, 0.0), vec2(0.0, 0.01), 0.1, vec3(1.0, 0.0, 0.0),
                             vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0));
    answer.colors[0] = vec4(normal, 1.0);
}
