/* Samples the layers of an array as cells of a UDIM set, in one row. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "array.glsl"
#include "sluice/udim.glsl"

layout(local_size_x = 64) in;

void main()
{
    if (gl_GlobalInvocationID.x >= params.count)
        return;
    uint at = params.first + gl_GlobalInvocationID.x;
    vec2 uv = vec2(inputs[at].uv[0], inputs[at].uv[1]);
    vec2 dx = vec2(inputs[at].dx[0], inputs[at].dx[1]);
    vec2 dy = vec2(inputs[at].dy[0], inputs[at].dy[1]);
    float bias = inputs[at].lodBias, anisotropy = inputs[at].maxAnisotropy;
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(params.tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(params.tableIndex).sizeY);
    uint columns = params.flags & 0xFFu, empty = params.flags >> 8u, worst = 0u, parts = 0u;
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (uint i = 0u; i < SLUICE_UDIM_PARTS; i++) {
        SluiceUdimPart part = sluiceFindUdimPart(uvec2(columns, 1u), size, uv, dx, dy, bias, anisotropy, i);
        if (!(part.weight > 0.0) || part.cell == empty)
            continue;
        uint missing, tableIndex = params.tableIndex + part.cell;
        sum += part.weight * sluiceSampleArrayGrad(layersTex, tableIndex, part.cell, part.uv, dx, dy, bias,
                                                   anisotropy, missing);
        total += part.weight;
        worst = max(worst, missing);
        parts++;
        sluiceWriteFeedback(tableIndex, part.uv, dx, dy, bias, anisotropy);
    }
    writeBoth(at, total > 0.0 ? sum / total : vec4(-1.0), worst, vec4(total), parts);
}
