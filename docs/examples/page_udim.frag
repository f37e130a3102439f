/* The lines that images.md shows about UDIM sets of a streamer, compiled as they are there. */
#version 450
#extension GL_GOOGLE_include_directive : require
#define SLUICE_SET 0
#include "sluice/bindings.glsl"
#include "sluice/sample_array.glsl"
#include "sluice/feedback.glsl"
#include "sluice/udim.glsl"

layout(set = 1, binding = 0) uniform sampler2DArray files;
layout(push_constant) uniform Draw { uint tableIndex; uint layers[100]; } draw;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;

const uint NO_FILE = 0xFFFFFFFFu;

void main()
{
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(draw.tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(draw.tableIndex).sizeY);
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (uint i = 0u; i < SLUICE_UDIM_PARTS; i++) {
        SluiceUdimPart part = sluiceFindUdimPart(uvec2(10u, 10u), size, uv, dx, dy, 0.0, 8.0, i);
        uint missing, layer = part.weight > 0.0 ? draw.layers[part.cell] : NO_FILE;
        if (layer == NO_FILE)
            continue;
        uint cell = draw.tableIndex + layer; /* the tableIndex of the cell */
        sum += part.weight * sluiceSampleArrayGrad(files, cell, layer, part.uv, dx, dy, 0.0, 8.0, missing);
        total += part.weight;
        sluiceWriteFeedback(cell, part.uv, dx, dy, 0.0, 8.0);
    }
    result = total > 0.0 ? sum / total : vec4(0.0);
}
