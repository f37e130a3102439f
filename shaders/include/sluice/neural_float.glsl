/*
 * Runs networks whose layers 0 to 2 are floating point. Only neural.glsl includes this file.
 *
 * SLUICE_NEURAL_FP8: weights and values are E4M3 numbers in 32-bit floats. Products are exact and sums have the
 * order of the inputs, so results are the bits of sluiceDecodeNeuralTexels with FP8 weights.
 * SLUICE_NEURAL_HALF: weights, values and sums are 16-bit floats, two per instruction. The result depends on the
 * device; docs/neural.md has the error.
 */
#ifndef SLUICE_NEURAL_FLOAT_GLSL
#define SLUICE_NEURAL_FLOAT_GLSL

#include "neural_values.glsl"

/** Returns a byte of E4M3 as a float. */
float sluiceNeuralFromE4M3(uint code)
{
    float magnitude = uintBitsToFloat(((code & 0x7Fu) << 20u) + 0x3C000000u);
    precise float small = 2.0 * magnitude - 0.015625; /* no implicit one */
    magnitude = (code & 0x78u) == 0u ? small : magnitude;
    return (code & 0x80u) != 0u ? -magnitude : magnitude;
}

/** Returns a number of an array of 16-bit floats in the weights. */
float sluiceNeuralHalfAt(uint s, uint firstWord, uint i)
{
    vec2 pair = unpackHalf2x16(SLUICE_NEURAL_WEIGHT_WORD(s, firstWord + i / 2u));
    return (i & 1u) != 0u ? pair.y : pair.x;
}

#ifdef SLUICE_NEURAL_HALF
#define SLUICE_NEURAL_WEIGHTS_PER_WORD 2u
#define SLUICE_NEURAL_VALUE_TYPE f16vec2
#define SLUICE_NEURAL_VALUE_COUNT (SLUICE_NEURAL_VALUES / 2)

/** Returns a sum of a layer. */
float sluiceNeuralFloatOutput(uint s, SluiceNeuralLayer layer, f16vec2 values[SLUICE_NEURAL_VALUE_COUNT], uint o)
{
    uint row = layer.weights + o * layer.inputWords;
    f16vec2 sums = f16vec2(0.0);
    SLUICE_NEURAL_UNROLL
    for (uint k = 0u; k < layer.inputWords; k++)
        sums = fma(values[k], unpackFloat2x16(SLUICE_NEURAL_WEIGHT_WORD(s, row + k)), sums);
    return float(sums.x) + float(sums.y) + sluiceNeuralHalfAt(s, layer.biases, o);
}

void sluiceNeuralPutPair(inout f16vec2 values[SLUICE_NEURAL_VALUE_COUNT], uint i, vec2 pair)
{
    values[i] = f16vec2(pair);
}
#else
#define SLUICE_NEURAL_WEIGHTS_PER_WORD 4u
#define SLUICE_NEURAL_VALUE_TYPE float
#define SLUICE_NEURAL_VALUE_COUNT SLUICE_NEURAL_VALUES

/** Returns a sum of a layer. */
float sluiceNeuralFloatOutput(uint s, SluiceNeuralLayer layer, float values[SLUICE_NEURAL_VALUE_COUNT], uint o)
{
    uint row = layer.weights + o * layer.inputWords;
    precise float sum = sluiceNeuralHalfAt(s, layer.biases, o);
    SLUICE_NEURAL_UNROLL
    for (uint k = 0u; k < layer.inputWords; k++) {
        uint word = SLUICE_NEURAL_WEIGHT_WORD(s, row + k);
        for (uint j = 0u; j < 4u; j++)
            sum = sum + values[4u * k + j] * sluiceNeuralFromE4M3(word >> 8u * j & 0xFFu);
    }
    return sum;
}

void sluiceNeuralPutPair(inout float values[SLUICE_NEURAL_VALUE_COUNT], uint i, vec2 pair)
{
    values[2u * i] = sluiceNeuralRoundE4M3(pair.x);
    values[2u * i + 1u] = sluiceNeuralRoundE4M3(pair.y);
}
#endif

/** Replaces the inputs of layer 0 or 1 by its outputs. */
void sluiceNeuralFloatHidden(uint s, SluiceNeuralLayer layer,
                             inout SLUICE_NEURAL_VALUE_TYPE values[SLUICE_NEURAL_VALUE_COUNT])
{
    SLUICE_NEURAL_VALUE_TYPE made[SLUICE_NEURAL_VALUE_COUNT];
    SLUICE_NEURAL_ROLL
    for (uint i = 0u; i < layer.outputs / 2u; i++) {
        float x = sluiceNeuralActivation(sluiceNeuralFloatOutput(s, layer, values, 2u * i));
        float y = sluiceNeuralActivation(sluiceNeuralFloatOutput(s, layer, values, 2u * i + 1u));
        sluiceNeuralPutPair(made, i, vec2(x, y));
    }
    values = made;
}

/** Returns the outputs of layer 2 as bytes, for the last layer. */
void sluiceNeuralFloatCodes(uint s, SluiceNeuralLayer layer,
                            SLUICE_NEURAL_VALUE_TYPE values[SLUICE_NEURAL_VALUE_COUNT],
                            out uint neurons[SLUICE_NEURAL_WORDS])
{
    SLUICE_NEURAL_ROLL
    for (uint i = 0u; i < layer.outputs / 4u; i++) {
        uint word = 0u;
        for (uint j = 0u; j < 4u; j++) {
            float y = sluiceNeuralActivation(sluiceNeuralFloatOutput(s, layer, values, 4u * i + j));
            word |= sluiceNeuralActivationCode(y) << 8u * j;
        }
        neurons[i] = word;
    }
}

/** Runs the network of a set on its inputs. */
void sluiceNeuralRunFloat(uint s, float inputs[SLUICE_NEURAL_VALUES], out float channels[SLUICE_NEURAL_CHANNELS])
{
    bool isSchema1 = SLUICE_NEURAL_IS_SCHEMA_1(s);
    uvec4 counts = isSchema1 ? uvec4(SLUICE_NEURAL_INPUT_COUNT(s), 64u, 64u, 64u) : uvec4(48u, 64u, 48u, 32u);
    uvec4 outputs = uvec4(counts.yzw, 16u), words = counts * outputs / SLUICE_NEURAL_WEIGHTS_PER_WORD;
    SLUICE_NEURAL_VALUE_TYPE values[SLUICE_NEURAL_VALUE_COUNT];
    uint neurons[SLUICE_NEURAL_WORDS];
    SluiceNeuralLayer layer;
    SLUICE_NEURAL_UNROLL
    for (uint i = 0u; i < counts.x / 2u; i++)
        sluiceNeuralPutPair(values, i, vec2(sluiceNeuralRoundHalf(inputs[2u * i]), sluiceNeuralRoundHalf(inputs[2u * i + 1u])));
    words.w = counts.w * 16u / 4u; /* bytes */
    layer.weights = 0u;
    layer.biases = words.x + words.y + words.z + words.w;
    SLUICE_NEURAL_UNROLL
    for (uint i = 0u; i < 3u; i++) {
        layer.inputWords = counts[i] / SLUICE_NEURAL_WEIGHTS_PER_WORD;
        layer.outputs = outputs[i];
        if (i < 2u)
            sluiceNeuralFloatHidden(s, layer, values);
        else
            sluiceNeuralFloatCodes(s, layer, values, neurons);
        layer.weights += words[i];
        layer.biases += outputs[i] / 2u;
    }
    layer.inputWords = counts.w / 4u;
    layer.scales = layer.biases;
    layer.biases = layer.scales + 16u;
    for (uint o = 0u; o < 16u; o++)
        channels[o] = sluiceNeuralOutput(s, layer, neurons, o);
}

#endif
