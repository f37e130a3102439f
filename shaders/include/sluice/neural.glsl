/*
 * Decodes one texel of a neural texture set (sluice/neural.h) with int8 weights: up to 16 channels at once,
 * the same bits as sluiceDecodeNeuralTexels. Choose the texel with stochastic_filter.glsl:
 *
 *     SluicePick pick = sluicePickTexel(uv, lod, sluiceGetNeuralSize(s, 0u), sluiceGetNeuralMipCount(s), modes,
 *                                       SLUICE_PICK_LINEAR, 0.0, random);
 *     float channels[SLUICE_NEURAL_CHANNELS];
 *     if (sluiceNeuralSample(s, pick.texel, pick.level, channels))
 *         shade(sluiceNeuralToLinear(channels[0], SLUICE_NEURAL_COLOR_SRGB), ...);
 *
 * `s` is any number by which the application finds a set. Definitions before this file:
 *
 *     #define SLUICE_NEURAL_CONSTANTS(s) sets[s].constants             // SluiceNeuralConstants, read
 *     #define SLUICE_NEURAL_LATENT_WORD(s, i) latents.words[first + i] // uint i of sluiceReadNeuralLatents
 *     #define SLUICE_NEURAL_WEIGHT_WORD(s, i) weights.words[first + i] // uint i of sluiceGetNeuralWeights (INT8)
 *
 * The calls of sluice/neural.h write constants, latents and weights; put them in std430 storage buffers. To
 * declare the first block, include "shared/neural.h" before. Latents may be a whole set or slices, also in byte
 * pages (demand_bytes.glsl).
 *
 * Optional definitions:
 *
 *     #define SLUICE_NEURAL_SCHEMA 3         // or 1: the only schema of the shader; default: any. Faster.
 *     #define SLUICE_NEURAL_INPUTS 64        // with schema 1: the only network; default: any. Faster.
 *     #define SLUICE_NEURAL_INTEGER_DOT      // uses VK_KHR_shader_integer_dot_product: enable its feature
 *     #define SLUICE_NEURAL_FP8              // weights are FP8: the bits of the host's decode with these
 *     #define SLUICE_NEURAL_HALF             // weights are HALF: computes in 16-bit floats (shaderFloat16)
 *     #define SLUICE_NEURAL_VECTOR           // uses VK_NV_cooperative_vector, with INT8 or FP8 weights that
 *                                            // sluiceConvertNeuralWeights wrote; needs SLUICE_NEURAL_SCHEMA and
 *                                            // a compiler with GL_NV_cooperative_vector
 *     #define SLUICE_NEURAL_VECTOR_WEIGHTS(s) weights // for it: array of uint in a storage buffer that begins with
 *                                            // the weights of the set
 *
 * sluice/neural_paths.h queries a device's support. neural_matrix.glsl decodes a subgroup's texels at once.
 *
 * Results with INT8 weights have the same bits on every device whose float multiplication rounds to nearest, except for
 * outputs below 2^-126.
 */
#ifndef SLUICE_NEURAL_GLSL
#define SLUICE_NEURAL_GLSL

#ifdef SLUICE_NEURAL_INTEGER_DOT
#extension GL_EXT_spirv_intrinsics : require
#endif
#ifdef SLUICE_NEURAL_HALF
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#endif
#ifdef SLUICE_NEURAL_VECTOR
#extension GL_NV_cooperative_vector : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#endif

#include "language.glsl"

/* With SLUICE_NEURAL_SCHEMA sizes of layers are constants. Sums are unrolled then, so that their inputs are
 * registers; outputs are not, so that shaders stay small. Define both as nothing to leave it to the compiler. */
#if defined(SLUICE_NEURAL_SCHEMA) && !defined(SLUICE_HLSL)
#extension GL_EXT_control_flow_attributes : require
#endif
#ifndef SLUICE_NEURAL_UNROLL
#if defined(SLUICE_NEURAL_SCHEMA) && defined(SLUICE_HLSL)
#define SLUICE_NEURAL_UNROLL [unroll]
#define SLUICE_NEURAL_ROLL [loop]
#elif defined(SLUICE_NEURAL_SCHEMA)
#define SLUICE_NEURAL_UNROLL [[unroll]]
#define SLUICE_NEURAL_ROLL SLUICE_DONT_UNROLL
#else
#define SLUICE_NEURAL_UNROLL
#define SLUICE_NEURAL_ROLL
#endif
#endif

#include "neural_inputs.glsl"
#include "shared/neural.h"

#ifdef SLUICE_NEURAL_INTEGER_DOT
/* OpSDot of SPV_KHR_integer_dot_product; capabilities DotProduct and DotProductInput4x8BitPacked. The last
 * argument is PackedVectorFormat4x8Bit. */
spirv_instruction(extensions = ["SPV_KHR_integer_dot_product"], capabilities = [6019, 6018], id = 4450)
int sluicePackedDot(uint a, uint b, spirv_literal int format);

/** Returns the dot product of four signed bytes in each of two words. */
int sluiceDotBytes(uint a, uint b)
{
    return sluicePackedDot(a, b, 0);
}
#else
/** Returns the dot product of four signed bytes in each of two words. */
int sluiceDotBytes(uint a, uint b)
{
    int x = int(a), y = int(b);
    return bitfieldExtract(x, 0, 8) * bitfieldExtract(y, 0, 8) +
           bitfieldExtract(x, 8, 8) * bitfieldExtract(y, 8, 8) +
           bitfieldExtract(x, 16, 8) * bitfieldExtract(y, 16, 8) + (x >> 24) * (y >> 24);
}
#endif

/** Layer of the network: offsets of its numbers in the weights, in words, and its size. */
struct SluiceNeuralLayer {
    uint weights, scales, biases;
    uint inputWords; /* four inputs each */
    uint outputs;
};

/** Returns a sum times its scale. */
float sluiceNeuralScaled(uint s, int sum, uint scaleWord)
{
    precise float scaled = float(sum) * uintBitsToFloat(SLUICE_NEURAL_WEIGHT_WORD(s, scaleWord));
    return scaled;
}

/** Returns the sum of an output, times its scale. */
float sluiceNeuralOutput(uint s, SluiceNeuralLayer layer, uint neurons[SLUICE_NEURAL_WORDS], uint o)
{
    int sum = int(SLUICE_NEURAL_WEIGHT_WORD(s, layer.biases + o));
    uint row = layer.weights + o * layer.inputWords;
    SLUICE_NEURAL_UNROLL
    for (uint k = 0u; k < layer.inputWords; k++)
        sum += sluiceDotBytes(neurons[k], SLUICE_NEURAL_WEIGHT_WORD(s, row + k));
    return sluiceNeuralScaled(s, sum, layer.scales + o);
}

/** Returns the activation of a sum as a byte: a cubic GELU, clamped to 3, in steps of 1/80. */
uint sluiceNeuralActivate(float r)
{
    precise float t = clamp(r * 0.333333 + 0.5, 0.0, 1.0);
    precise float y = min(r, 3.0) * t;
    precise float steps = y * 80.0;
    return uint(int(roundEven(steps)) - 113) & 0xFFu;
}

/** Replaces the inputs of a hidden layer by its outputs. */
void sluiceNeuralHidden(uint s, SluiceNeuralLayer layer, inout uint neurons[SLUICE_NEURAL_WORDS])
{
    uint made[16];
    SLUICE_NEURAL_ROLL
    for (uint i = 0u; i < layer.outputs / 4u; i++) {
        made[i] = 0u;
        for (uint j = 0u; j < 4u; j++)
            made[i] |= sluiceNeuralActivate(sluiceNeuralOutput(s, layer, neurons, 4u * i + j)) << (8u * j);
    }
    SLUICE_NEURAL_UNROLL
    for (uint i = 0u; i < layer.outputs / 4u; i++)
        neurons[i] = made[i];
}

/** Runs the network of a set on its inputs. */
void sluiceNeuralRun(uint s, inout uint neurons[SLUICE_NEURAL_WORDS], out float channels[SLUICE_NEURAL_CHANNELS])
{
    bool isSchema1 = SLUICE_NEURAL_IS_SCHEMA_1(s);
    uvec4 inputs = isSchema1 ? uvec4(SLUICE_NEURAL_INPUT_COUNT(s), 64u, 64u, 64u) : uvec4(48u, 64u, 48u, 32u);
    uvec4 outputs = uvec4(inputs.yzw, 16u), words = inputs * outputs / 4u;
    SluiceNeuralLayer layer;
    layer.weights = 0u;
    layer.scales = words.x + words.y + words.z + words.w;
    layer.biases = layer.scales + outputs.x + outputs.y + outputs.z + outputs.w;
    SLUICE_NEURAL_UNROLL
    for (uint i = 0u; i < 4u; i++) {
        layer.inputWords = inputs[i] / 4u;
        layer.outputs = outputs[i];
        if (i < 3u)
            sluiceNeuralHidden(s, layer, neurons);
        else
            for (uint o = 0u; o < 16u; o++)
                channels[o] = sluiceNeuralOutput(s, layer, neurons, o);
        layer.weights += words[i];
        layer.scales += outputs[i];
        layer.biases += outputs[i];
    }
}

#if defined(SLUICE_NEURAL_FP8) || defined(SLUICE_NEURAL_HALF)
#define SLUICE_NEURAL_INPUT_TYPE float inputs[SLUICE_NEURAL_VALUES]
#define SLUICE_NEURAL_FIND_INPUTS sluiceNeuralInputValues
#else
#define SLUICE_NEURAL_INPUT_TYPE uint inputs[SLUICE_NEURAL_WORDS]
#define SLUICE_NEURAL_FIND_INPUTS sluiceNeuralInputs
#endif
#if defined(SLUICE_NEURAL_VECTOR)
#define SLUICE_NEURAL_RUN sluiceNeuralRunVector
#if defined(SLUICE_NEURAL_FP8)
#include "neural_values.glsl"
#endif
#include "neural_vector.glsl"
#elif defined(SLUICE_NEURAL_FP8) || defined(SLUICE_NEURAL_HALF)
#define SLUICE_NEURAL_RUN sluiceNeuralRunFloat
#include "neural_float.glsl"
#else
#define SLUICE_NEURAL_RUN sluiceNeuralRun
#endif

/** Returns the number of mips of a set. */
uint sluiceGetNeuralMipCount(uint s)
{
    return SLUICE_NEURAL_CONSTANTS(s).mipCount;
}

/** Returns the size of a mip in texels. */
uvec2 sluiceGetNeuralSize(uint s, uint mip)
{
    return max(uvec2(SLUICE_NEURAL_CONSTANTS(s).width, SLUICE_NEURAL_CONSTANTS(s).height) >> mip, SLUICE_SPLAT(uvec2, 1u));
}

/**
 * Decodes a texel of a mip. Channels are in their own color spaces and may lie a little outside of 0 to 1.
 * Channels without a texture in the set are undefined.
 *
 * False, and all channels 0, if the latents of the texel are not among the slices, or if there is no such
 * texel: show a coarser mip then.
 */
bool sluiceNeuralSample(uint s, ivec2 texel, uint mip, out float channels[SLUICE_NEURAL_CHANNELS])
{
    for (uint i = 0u; i < SLUICE_NEURAL_CHANNELS; i++)
        channels[i] = 0.0;
    if (mip >= sluiceGetNeuralMipCount(s) || any(lessThan(texel, SLUICE_SPLAT(ivec2, 0))) ||
        any(greaterThanEqual(uvec2(texel), sluiceGetNeuralSize(s, mip))))
        return false;
    SLUICE_NEURAL_INPUT_TYPE;
    if (!SLUICE_NEURAL_FIND_INPUTS(s, uvec2(texel), mip, sluiceGetNeuralSize(s, mip), inputs))
        return false;
    SLUICE_NEURAL_RUN(s, inputs, channels);
    return true;
}

/** Returns the linear value of a channel of a color space (SLUICE_NEURAL_COLOR_*). */
float sluiceNeuralToLinear(float value, uint colorSpace)
{
    float h = abs(value);
    if (colorSpace == SLUICE_NEURAL_COLOR_SRGB)
        return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
    if (colorSpace == SLUICE_NEURAL_COLOR_HLG)
        return sign(value) * (h < 0.5 ? 4.0 * h * h : exp((h - 0.55991073) / 0.17883277) + 0.28466892);
    return value;
}

#endif
