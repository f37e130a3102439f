/* integer.comp in HLSL. */
#include "sluice/shared/texture_table.h"
#include "probe_shared.h"

[[vk::binding(0)]] StructuredBuffer<SluiceTextureEntry> textureTable;
[[vk::binding(1)]] StructuredBuffer<uint> minMip;
[[vk::binding(2)]] RWStructuredBuffer<uint> feedback;
[[vk::binding(3)]] StructuredBuffer<ProbeInput> inputs;
[[vk::binding(4)]] RWStructuredBuffer<ProbeOutput> outputs;
#ifdef INTEGER_SIGNED
[[vk::binding(5)]] Texture2D<int4> tex;
#define SAMPLE sluiceSampleIntGrad
#else
[[vk::binding(5)]] Texture2D<uint4> tex;
#define SAMPLE sluiceSampleUintGrad
#endif
[[vk::binding(5)]] SamplerState texSampler;
[[vk::push_constant]] ConstantBuffer<ProbeParams> params;

#define SLUICE_TEXTURE_ENTRY(i) textureTable[i]
#define SLUICE_MIN_MIP_WORD(i) minMip[i]
#define SLUICE_FEEDBACK_WORD(i) feedback[i]
#include "sluice/feedback.glsl"
#include "sluice/sample_integer.glsl"

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    if (id.x >= params.count)
        return;
    uint at = params.first + id.x, missing;
    float2 uv = float2(inputs[at].uv[0], inputs[at].uv[1]);
    float2 dx = float2(inputs[at].dx[0], inputs[at].dx[1]), dy = float2(inputs[at].dy[0], inputs[at].dy[1]);
    uint4 number = uint4(SAMPLE(tex, texSampler, params.tableIndex, uv, dx, dy, missing));
    SluiceSampling s = sluiceResolveSampling(params.tableIndex, uv, dx, dy, 0.0, 1.0);
    for (uint i = 0u; i < 4u; i++)
        outputs[at].footprint[i] = number[i];
    outputs[at].missingLevels = missing;
    outputs[at].level = uint(sluiceNearestLevel(params.tableIndex, s));
    outputs[at].wantedLevel = s.wantedLevel;
    outputs[at].lod = s.lod;
    if ((params.flags & PROBE_FEEDBACK) != 0u)
        sluiceWriteFeedback(params.tableIndex, uv, dx, dy, 0.0, 1.0);
}
