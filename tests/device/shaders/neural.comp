/*
 * Decodes texels of a rectangle of a mip with neural.glsl. NEURAL_MATRIX: with neural_matrix.glsl, whose shape is
 * specialized.
 */
#version 450
#extension GL_GOOGLE_include_directive : require
#ifdef NEURAL_MATRIX
#pragma use_vulkan_memory_model
#endif

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
#ifdef NEURAL_MATRIX
layout(constant_id = 0) const uint matrixM = 16u;
layout(constant_id = 1) const uint matrixN = 16u;
layout(constant_id = 2) const uint matrixK = 32u;
#define SLUICE_NEURAL_MATRIX_WEIGHTS(s) weights
#define SLUICE_NEURAL_MATRIX_FIRST(s) 0u
#define SLUICE_NEURAL_GROUP 64
#define SLUICE_NEURAL_MATRIX_M matrixM
#define SLUICE_NEURAL_MATRIX_N matrixN
#define SLUICE_NEURAL_MATRIX_K matrixK
#include "sluice/neural_matrix.glsl"
#define SAMPLE sluiceNeuralSampleSubgroup
#else
#define SLUICE_NEURAL_VECTOR_WEIGHTS(s) weights
#include "sluice/neural.glsl"
#define SAMPLE sluiceNeuralSample
#endif

void main()
{
    uint i = gl_GlobalInvocationID.x;
    bool exists = i < params.width * params.height;
    ivec2 texel = ivec2(params.x, params.y) + ivec2(i % params.width, i / params.width);
    float channels[SLUICE_NEURAL_CHANNELS];
    bool resident = SAMPLE(params.set, exists ? texel : ivec2(-1), params.mip, channels);
    if (!exists)
        return;
    if (params.colorSpace != 0u)
        for (uint c = 0u; c < SLUICE_NEURAL_CHANNELS; c++)
            channels[c] = sluiceNeuralToLinear(channels[c], params.colorSpace);
    for (uint c = 0u; c < SLUICE_NEURAL_CHANNELS; c++)
        outputs[i].channels[c] = channels[c];
    outputs[i].resident = resident ? 1u : 0u;
    outputs[i].size = sluiceGetNeuralSize(params.set, params.mip).x | sluiceGetNeuralSize(params.set, params.mip).y << 16u;
    outputs[i].mipCount = sluiceGetNeuralMipCount(params.set);
}
