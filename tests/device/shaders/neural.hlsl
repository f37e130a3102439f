/* neural.comp in HLSL. */
#include "sluice/shared/neural.h"
#include "neural_shared.h"

[[vk::binding(0)]] StructuredBuffer<SluiceNeuralConstants> sets;
[[vk::binding(1)]] StructuredBuffer<uint> latents;
[[vk::binding(2)]] StructuredBuffer<uint> weights;
[[vk::binding(3)]] RWStructuredBuffer<NeuralOutput> outputs;
[[vk::push_constant]] ConstantBuffer<NeuralParams> params;

#define SLUICE_NEURAL_CONSTANTS(s) sets[s]
#define SLUICE_NEURAL_LATENT_WORD(s, i) latents[i]
#define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights[i]
#include "sluice/neural.glsl"

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    uint i = id.x;
    if (i >= params.width * params.height)
        return;
    int2 texel = int2(params.x, params.y) + int2(i % params.width, i / params.width);
    float channels[SLUICE_NEURAL_CHANNELS];
    bool resident = sluiceNeuralSample(params.set, texel, params.mip, channels);
    for (uint c = 0u; c < SLUICE_NEURAL_CHANNELS; c++)
        outputs[i].channels[c] =
            params.colorSpace != 0u ? sluiceNeuralToLinear(channels[c], params.colorSpace) : channels[c];
    uint2 size = sluiceGetNeuralSize(params.set, params.mip);
    outputs[i].resident = resident ? 1u : 0u;
    outputs[i].size = size.x | size.y << 16u;
    outputs[i].mipCount = sluiceGetNeuralMipCount(params.set);
}
