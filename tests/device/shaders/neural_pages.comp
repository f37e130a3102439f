/* Samples texels of a neural set whose latents are pages. */
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_GOOGLE_include_directive : require

#define SLUICE_DEMAND_SET 0
#include "sluice/demand_bindings.glsl"
#include "neural_pages_shared.h"
#include "sluice/shared/neural_pages.h"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) readonly buffer Set { SluiceNeuralPages pages; } neuralSet;
layout(std430, set = 1, binding = 1) readonly buffer Weights { uint words[]; } weights;
layout(std430, set = 1, binding = 2) readonly buffer Inputs { NeuralPageInput inputs[]; };
layout(std430, set = 1, binding = 3) writeonly buffer Outputs { NeuralPageOutput outputs[]; };
layout(push_constant) uniform Push { uint count, firstPage; };

#define SLUICE_NEURAL_PAGES(s) neuralSet.pages
#define SLUICE_NEURAL_FIRST_PAGE(s) firstPage
#define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights.words[i]
#include "sluice/neural_pages.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    NeuralPageInput at = inputs[i];
    float channels[SLUICE_NEURAL_CHANNELS];
    uint shown;
    outputs[i].resident = uint(sluiceNeuralSampleOrRequest(0u, ivec2(at.x, at.y), at.mip, shown, channels));
    outputs[i].shown = shown;
    for (uint c = 0u; c < SLUICE_NEURAL_CHANNELS; c++)
        outputs[i].channels[c] = channels[c];
}
