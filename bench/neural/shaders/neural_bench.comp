/*
 * A screen over one material of eight channels: decoded from latents at one random texel per pixel,
 * or sampled trilinearly from two textures of four channels (NEURAL_BENCH_TEXTURES).
 */
#version 450
#extension GL_GOOGLE_include_directive : require
#ifdef NEURAL_MATRIX
#pragma use_vulkan_memory_model
#endif

#include "sluice/shared/neural.h"
#include "neural_bench_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) writeonly buffer Picture { uvec2 pixels[]; };
layout(std430, binding = 1) readonly buffer Sets { SluiceNeuralConstants sets[]; };
layout(std430, binding = 2) readonly buffer Latents { uint latents[]; };
layout(std430, binding = 3) readonly buffer Weights { uint weights[]; };
layout(std140, binding = 4) uniform UniformWeights { uvec4 uniformWeights[NEURAL_BENCH_MAX_WEIGHTS / 16]; };
layout(binding = 5) uniform sampler2D first;
layout(binding = 6) uniform sampler2D second;
layout(push_constant) uniform Push { NeuralBenchParams params; };

#define SLUICE_NEURAL_CONSTANTS(s) sets[s]
#define SLUICE_NEURAL_LATENT_WORD(s, i) latents[i]
#ifdef NEURAL_BENCH_UNIFORM
#define SLUICE_NEURAL_WEIGHT_WORD(s, i) uniformWeights[(i) >> 2u][(i) & 3u]
#else
#define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights[i]
#endif
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
#include "sluice/stochastic_filter.glsl"

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    bool exists = pixel.x < params.width && pixel.y < params.height;
#ifndef NEURAL_MATRIX /* its subgroups must stay complete */
    if (!exists)
        return;
#endif
    vec2 uv = (vec2(pixel) + 0.5) * vec2(params.uvPerPixel[0], params.uvPerPixel[1]);
    vec4 low, high;
#ifdef NEURAL_BENCH_TEXTURES
    low = textureLod(first, uv, params.lod);
    high = textureLod(second, uv, params.lod);
#else
    float channels[SLUICE_NEURAL_CHANNELS];
    vec2 random = sluiceRandomPair(uvec3(pixel, params.frame));
    SluicePick pick = sluicePickTexel(uv, params.lod, uvec2(params.textureSize[0], params.textureSize[1]),
                                      sluiceGetNeuralMipCount(0u), uvec2(SLUICE_ADDRESS_MODE_REPEAT),
                                      SLUICE_PICK_LINEAR, 0.0, random);
    SAMPLE(0u, exists ? pick.texel : ivec2(-1), pick.level, channels);
    low = vec4(channels[0], channels[1], channels[2], channels[3]);
    high = vec4(channels[4], channels[5], channels[6], channels[7]);
#endif
    if (exists)
        pixels[pixel.y * params.width + pixel.x] = uvec2(packUnorm4x8(low), packUnorm4x8(high));
}
