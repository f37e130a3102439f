/* The lines that docs/demand.md shows, compiled as they are there. A shader that runs is demand.comp. */
#version 450
#extension GL_GOOGLE_include_directive : require

#extension GL_EXT_buffer_reference_uvec2 : require

#define SLUICE_DEMAND_SET 0
#include "sluice/demand_bindings.glsl"
#include "sluice/demand.glsl"

layout(std430, buffer_reference, buffer_reference_align = 16) readonly buffer Vertices { vec4 positions[]; };
layout(std430, set = 1, binding = 0) buffer Answer { vec4 position; uvec2 values[]; } answer;
layout(push_constant) uniform Draw { uint index; uint firstPage; } draw;
layout(local_size_x = 8, local_size_y = 8) in;

void sampleTexture(uint index, vec2 uv, vec2 dx, vec2 dy)
{
    bool resident;
    vec4 color = sluiceDemandGrad(index, uv, dx, dy, resident);
    if (!resident)
        ; /* keep this pixel for the next launch; asking has been done */
    answer.values[0].x = packUnorm4x8(color);
}

void mapPage(uint firstPage, uint i)
{
    uvec2 value;
    if (sluiceMapOrRequest(firstPage + i, value))
        ; /* an address, an index, whatever pfnFill said */
    answer.values[1] = value;
}

void mapVertices(uint firstPage, uint i)
{
    uvec2 value;
    if (sluiceMapOrRequest(firstPage + i, value))
        answer.position = Vertices(value).positions[0];
}

void main()
{
    sampleTexture(draw.index, vec2(0.5), vec2(0.01, 0.0), vec2(0.0, 0.01));
    mapPage(draw.firstPage, gl_GlobalInvocationID.x);
    mapVertices(draw.firstPage, gl_GlobalInvocationID.y);
}
