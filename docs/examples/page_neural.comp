/* The lines that docs/neural.md shows, compiled as they are there. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/neural.h"

layout(std430, binding = 0) readonly buffer Sets { SluiceNeuralConstants sets[]; };
layout(std430, binding = 1) readonly buffer Latents { uint latents[]; };
layout(std430, binding = 2) readonly buffer Weights { uint weights[]; };
layout(std430, binding = 3) buffer Answer { vec4 colors[]; } answer;
layout(push_constant) uniform Push { uint frame; } push;
layout(local_size_x = 8, local_size_y = 8) in;

#define SLUICE_NEURAL_CONSTANTS(s) sets[s]
#define SLUICE_NEURAL_LATENT_WORD(s, i) latents[i]
#define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights[i]
#include "sluice/neural.glsl"
#include "sluice/stochastic_filter.glsl"

vec3 sampleAlbedo(uint s, vec2 uv, float lod, uvec2 pixel, uint frame)
{
    vec2 random = sluiceRandomPair(uvec3(pixel, frame));
    SluicePick pick = sluicePickTexel(uv, lod, sluiceGetNeuralSize(s, 0u), sluiceGetNeuralMipCount(s),
                                      uvec2(SLUICE_ADDRESS_MODE_REPEAT), SLUICE_PICK_LINEAR, 0.0, random);
    float channels[SLUICE_NEURAL_CHANNELS];
    bool resident = sluiceNeuralSample(s, pick.texel, pick.level, channels);
    vec3 albedo = vec3(0.5);
    for (int c = 0; c < 3 && resident; c++)
        albedo[c] = sluiceNeuralToLinear(channels[c], SLUICE_NEURAL_COLOR_SRGB);
    return albedo;
}

void main()
{
    answer.colors[0] = vec4(sampleAlbedo(0u, vec2(0.5), 0.5, gl_GlobalInvocationID.xy, push.frame), 1.0);
}
