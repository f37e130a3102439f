/*
 * Decodes a rectangle of a mip of a neural set to texels or blocks in a buffer. A workgroup decodes
 * 8 x 8 texels, which are four blocks.
 */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/neural.h"
#include "sluice/shared/neural_tile.h"

layout(local_size_x = SLUICE_NEURAL_GROUP, local_size_y = SLUICE_NEURAL_GROUP) in;
layout(push_constant) uniform Push { SluiceNeuralTile tile; };
layout(std430, binding = 0) readonly buffer Constants { SluiceNeuralConstants constants; } decodable;
layout(std430, binding = 1) readonly buffer Latents { uint words[]; } latents;
layout(std430, binding = 2) readonly buffer Weights { uint words[]; } weights;
layout(std430, binding = 3) writeonly buffer Output { uint words[]; } stored;

#define SLUICE_NEURAL_CONSTANTS(s) decodable.constants
#define SLUICE_NEURAL_LATENT_WORD(s, i) latents.words[i]
#define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights.words[i]
#include "sluice/encode_blocks.glsl"
#include "sluice/neural.glsl"

shared vec4 texels[SLUICE_NEURAL_GROUP * SLUICE_NEURAL_GROUP];
/* Errors and blocks of BC7 candidates, by block and candidate. */
shared float errors[SLUICE_NEURAL_GROUP * SLUICE_NEURAL_GROUP];
shared uvec4 blocks[SLUICE_NEURAL_GROUP * SLUICE_NEURAL_GROUP];

float fromLinear(float value, uint space)
{
    float h = abs(value);
    if (space == SLUICE_NEURAL_COLOR_SRGB)
        return value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1.0 / 2.4) - 0.055;
    if (space == SLUICE_NEURAL_COLOR_HLG)
        return sign(value) * (h < 1.0 ? 0.5 * sqrt(h) : 0.17883277 * log(h - 0.28466892) + 0.55991073);
    return value;
}

vec4 decodeTexel(uvec2 at)
{
    float channels[SLUICE_NEURAL_CHANNELS];
    vec4 color = vec4(0, 0, 0, 1);
    sluiceNeuralSample(0u, ivec2(uvec2(tile.x, tile.y) + at), tile.mip, channels);
    for (uint c = 0u; c < tile.channelCount; c++) {
        uint spaces = tile.spaces >> c * 2u * SLUICE_NEURAL_SPACE_BITS, mask = (1u << SLUICE_NEURAL_SPACE_BITS) - 1u;
        uint from = spaces & mask, to = spaces >> SLUICE_NEURAL_SPACE_BITS & mask;
        float value = channels[tile.firstChannel + c];
        color[c] = from == to ? value : fromLinear(sluiceNeuralToLinear(value, from), to);
    }
    const float most = 65504.0; /* largest 16-bit float */
    return tile.store == SLUICE_NEURAL_STORE_RGBA16F ? clamp(color, -most, most) : clamp(color, 0.0, 1.0);
}

/* The texels of one of the workgroup's four blocks. */
void loadBlock(uint number, out vec4 colors[16])
{
    uvec2 first = uvec2(number & 1u, number >> 1u) * 4u;
    for (uint i = 0u; i < 16u; i++)
        colors[i] = texels[(first.y + i / 4u) * SLUICE_NEURAL_GROUP + first.x + i % 4u];
}

void storeBlock(uint number, uint words, uvec4 made)
{
    uvec2 block = gl_WorkGroupID.xy * 2u + uvec2(number & 1u, number >> 1u);
    if (any(greaterThanEqual(4u * block, uvec2(tile.width, tile.height))))
        return;
    uint at = tile.word + block.y * tile.pitch + block.x * words;
    for (uint i = 0u; i < words; i++)
        stored.words[at + i] = made[i];
}

/* One invocation per block. */
void encodeBlock(uint number)
{
    vec4 colors[16];
    float red[16], green[16];
    loadBlock(number, colors);
    for (uint i = 0u; i < 16u; i++) {
        red[i] = colors[i].r;
        green[i] = colors[i].g;
    }
    if (tile.store == SLUICE_NEURAL_STORE_BC5)
        storeBlock(number, 4u, sluiceEncodeBc5(red, green));
    else if (tile.store == SLUICE_NEURAL_STORE_BC4)
        storeBlock(number, 2u, uvec4(sluiceEncodeBc4(red), 0u, 0u));
    else
        storeBlock(number, 2u, uvec4(sluiceEncodeBc1(colors), 0u, 0u));
}

/* 16 invocations per block: each tries another way to encode it. */
void encodeBc7()
{
    uint number = gl_LocalInvocationIndex / 16u, candidate = gl_LocalInvocationIndex % 16u;
    float error = 1e9;
    if (candidate < SLUICE_BC7_CANDIDATES) {
        vec4 colors[16];
        loadBlock(number, colors);
        SluiceBc7Candidate tried = sluiceTryBc7(colors, candidate);
        error = tried.error;
        blocks[gl_LocalInvocationIndex] = tried.block;
    }
    errors[gl_LocalInvocationIndex] = error;
    barrier();
    if (candidate != 0u)
        return;
    uint best = gl_LocalInvocationIndex;
    for (uint i = 1u; i < SLUICE_BC7_CANDIDATES; i++)
        if (errors[gl_LocalInvocationIndex + i] < errors[best])
            best = gl_LocalInvocationIndex + i;
    storeBlock(number, 4u, blocks[best]);
}

void main()
{
    /* Blocks that the edge cuts are filled up with its texels. */
    uvec2 at = gl_GlobalInvocationID.xy;
    bool inside = all(lessThan(at, uvec2(tile.width, tile.height)));
    vec4 color = decodeTexel(min(at, uvec2(tile.width, tile.height) - 1u));
    if (tile.store == SLUICE_NEURAL_STORE_RGBA8) {
        if (inside)
            stored.words[tile.word + at.y * tile.pitch + at.x] = packUnorm4x8(color);
        return;
    }
    if (tile.store == SLUICE_NEURAL_STORE_RGBA16F) {
        uint word = tile.word + at.y * tile.pitch + 2u * at.x;
        if (inside) {
            stored.words[word] = packHalf2x16(color.rg);
            stored.words[word + 1u] = packHalf2x16(color.ba);
        }
        return;
    }
    texels[gl_LocalInvocationIndex] = color;
    barrier();
    if (tile.store == SLUICE_NEURAL_STORE_BC7)
        encodeBc7();
    else if (gl_LocalInvocationIndex < 4u)
        encodeBlock(gl_LocalInvocationIndex);
}
