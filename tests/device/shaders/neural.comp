/* Decodes texels of a rectangle of a mip with neural.glsl. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/neural.h"
#include "neural_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Sets { SluiceNeuralConstants sets[]; };
layout(std430, binding = 1) readonly buffer Latents { uint latents[]; };
layout(std430, binding = 2) readonly buffer Weights { uint weights[]; };
layout(std430, binding = 3) writeonly buffer Outputs { NeuralOutput outputs[]; };
layout(push_constant) uniform Push { NeuralParams params; };

#define SLUICE_NEURAL_CONSTANTS(s) sets[s]
#define SLUICE_NEURAL_LATENT_WORD(s, i) latents[i]
#define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights[i]
#include "sluice/neural.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.width * params.height)
        return;
    ivec2 texel = ivec2(params.x, params.y) + ivec2(i % params.width, i / params.width);
    float channels[SLUICE_NEURAL_CHANNELS];
    bool resident = sluiceNeuralSample(params.set, texel, params.mip, channels);
    if (params.colorSpace != 0u)
        for (uint c = 0u; c < SLUICE_NEURAL_CHANNELS; c++)
            channels[c] = sluiceNeuralToLinear(channels[c], params.colorSpace);
    for (uint c = 0u; c < SLUICE_NEURAL_CHANNELS; c++)
        outputs[i].channels[c] = channels[c];
    outputs[i].resident = resident ? 1u : 0u;
    outputs[i].size = sluiceGetNeuralSize(params.set, params.mip).x | sluiceGetNeuralSize(params.set, params.mip).y << 16u;
    outputs[i].mipCount = sluiceGetNeuralMipCount(params.set);
}
