/* udim.comp in HLSL: the layers of an array as cells of a UDIM set, in one row. */
#include "array_bindings.hlsl"
#include "sluice/udim.glsl"

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    if (id.x >= params.count)
        return;
    uint at = params.first + id.x;
    float2 uv = float2(inputs[at].uv[0], inputs[at].uv[1]);
    float2 dx = float2(inputs[at].dx[0], inputs[at].dx[1]);
    float2 dy = float2(inputs[at].dy[0], inputs[at].dy[1]);
    float bias = inputs[at].lodBias, anisotropy = inputs[at].maxAnisotropy;
    float2 size = float2(SLUICE_TEXTURE_ENTRY(params.tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(params.tableIndex).sizeY);
    uint columns = params.flags & 0xFFu, empty = params.flags >> 8u, worst = 0u, parts = 0u;
    float4 sum = float4(0.0, 0.0, 0.0, 0.0);
    float total = 0.0;
    for (uint i = 0u; i < SLUICE_UDIM_PARTS; i++) {
        SluiceUdimPart part = sluiceFindUdimPart(uint2(columns, 1u), size, uv, dx, dy, bias, anisotropy, i);
        if (!(part.weight > 0.0) || part.cell == empty)
            continue;
        uint missing, tableIndex = params.tableIndex + part.cell;
        sum += part.weight * sluiceSampleArrayGrad(layersTex, layersTexSampler, tableIndex, part.cell, part.uv, dx, dy,
                                                   bias, anisotropy, missing);
        total += part.weight;
        worst = max(worst, missing);
        parts++;
        sluiceWriteFeedback(tableIndex, part.uv, dx, dy, bias, anisotropy);
    }
    float4 color = float4(-1.0, -1.0, -1.0, -1.0);
    if (total > 0.0)
        color = sum / total;
    for (uint c = 0u; c < 4u; c++) {
        outputs[at].color[c] = color[c];
        outputs[at].footprint[c] = asuint(total);
    }
    outputs[at].missingLevels = worst;
    outputs[at].wantedLevel = parts;
}
