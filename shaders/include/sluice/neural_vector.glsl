/*
 * Runs the network of a neural texture with VK_NV_cooperative_vector: a layer is one instruction. Only neural.glsl
 * includes this file, if SLUICE_NEURAL_VECTOR is defined. Weights are those of sluiceConvertNeuralWeights.
 *
 * INT8 sums are exact, so results are the bits of the other paths. With SLUICE_NEURAL_FP8 the device rounds the
 * inputs of layers 0 to 2 and chooses the precision of their sums; docs/neural.md has the error.
 */
#ifndef SLUICE_NEURAL_VECTOR_GLSL
#define SLUICE_NEURAL_VECTOR_GLSL

#if SLUICE_NEURAL_SCHEMA == 3
#define SLUICE_NEURAL_COUNTS_0 48
#define SLUICE_NEURAL_COUNTS_1 64
#define SLUICE_NEURAL_COUNTS_2 48
#define SLUICE_NEURAL_COUNTS_3 32
#else
#define SLUICE_NEURAL_COUNTS_0 SLUICE_NEURAL_INPUTS
#define SLUICE_NEURAL_COUNTS_1 64
#define SLUICE_NEURAL_COUNTS_2 64
#define SLUICE_NEURAL_COUNTS_3 64
#endif

/* Words of the weights where numbers of a layer begin, behind four offsets of matrices. */
#define SLUICE_NEURAL_VECTOR_HEAD 16

/* Defines a function that sets `sums` to the products of four inputs per word with a layer, plus its biases. */
#define SLUICE_NEURAL_VECTOR_INT8(name, K, M)                                                                        \
    void name(uint s, uint matrix, uint biases, uint neurons[SLUICE_NEURAL_WORDS], out coopvecNV<int32_t, M> sums)   \
    {                                                                                                                \
        coopvecNV<uint32_t, (K / 4)> inputs;                                                                         \
        SLUICE_NEURAL_UNROLL                                                                                         \
        for (int i = 0; i < K / 4; i++)                                                                              \
            inputs[i] = neurons[i];                                                                                  \
        coopVecMatMulAddNV(sums, inputs, gl_ComponentTypeSignedInt8PackedNV, SLUICE_NEURAL_VECTOR_WEIGHTS(s),        \
                           SLUICE_NEURAL_WEIGHT_WORD(s, matrix), gl_ComponentTypeSignedInt8NV,                       \
                           SLUICE_NEURAL_VECTOR_WEIGHTS(s), 4u * biases, gl_ComponentTypeSignedInt32NV, M, K,        \
                           gl_CooperativeVectorMatrixLayoutInferencingOptimalNV, false, 0);                          \
    }

/* Defines a function that replaces the inputs of a hidden layer by its outputs. */
#define SLUICE_NEURAL_VECTOR_HIDDEN(name, sum, K, M)                                                                 \
    SLUICE_NEURAL_VECTOR_INT8(sum, K, M)                                                                             \
    void name(uint s, uint matrix, uint scales, uint biases, inout uint neurons[SLUICE_NEURAL_WORDS])                \
    {                                                                                                                \
        coopvecNV<int32_t, M> sums;                                                                                  \
        sum(s, matrix, biases, neurons, sums);                                                                       \
        SLUICE_NEURAL_UNROLL                                                                                         \
        for (int i = 0; i < M / 4; i++) {                                                                            \
            uint word = 0u;                                                                                          \
            SLUICE_NEURAL_UNROLL                                                                                     \
            for (int j = 0; j < 4; j++)                                                                              \
                word |= sluiceNeuralActivate(sluiceNeuralScaled(s, sums[4 * i + j], scales + uint(4 * i + j)))       \
                        << 8 * j;                                                                                    \
            neurons[i] = word;                                                                                       \
        }                                                                                                            \
    }

SLUICE_NEURAL_VECTOR_INT8(sluiceNeuralVectorSums3, SLUICE_NEURAL_COUNTS_3, 16)

/** Runs the last layer. */
void sluiceNeuralVectorLast(uint s, uint scales, uint biases, uint neurons[SLUICE_NEURAL_WORDS],
                            out float channels[SLUICE_NEURAL_CHANNELS])
{
    coopvecNV<int32_t, 16> sums;
    sluiceNeuralVectorSums3(s, 3u, biases, neurons, sums);
    SLUICE_NEURAL_UNROLL
    for (int o = 0; o < 16; o++)
        channels[o] = sluiceNeuralScaled(s, sums[o], scales + uint(o));
}

#ifndef SLUICE_NEURAL_FP8
SLUICE_NEURAL_VECTOR_HIDDEN(sluiceNeuralVectorLayer0, sluiceNeuralVectorSums0, SLUICE_NEURAL_COUNTS_0,
                            SLUICE_NEURAL_COUNTS_1)
SLUICE_NEURAL_VECTOR_HIDDEN(sluiceNeuralVectorLayer1, sluiceNeuralVectorSums1, SLUICE_NEURAL_COUNTS_1,
                            SLUICE_NEURAL_COUNTS_2)
SLUICE_NEURAL_VECTOR_HIDDEN(sluiceNeuralVectorLayer2, sluiceNeuralVectorSums2, SLUICE_NEURAL_COUNTS_2,
                            SLUICE_NEURAL_COUNTS_3)

/** Runs the network of a set on its inputs. Biases lie behind all scales. */
void sluiceNeuralRunVector(uint s, uint neurons[SLUICE_NEURAL_WORDS], out float channels[SLUICE_NEURAL_CHANNELS])
{
    const uint hidden = uint(SLUICE_NEURAL_COUNTS_1 + SLUICE_NEURAL_COUNTS_2 + SLUICE_NEURAL_COUNTS_3);
    uint scales = SLUICE_NEURAL_VECTOR_HEAD, biases = scales + hidden + 16u;
    sluiceNeuralVectorLayer0(s, 0u, scales, biases, neurons);
    scales += uint(SLUICE_NEURAL_COUNTS_1);
    biases += uint(SLUICE_NEURAL_COUNTS_1);
    sluiceNeuralVectorLayer1(s, 1u, scales, biases, neurons);
    scales += uint(SLUICE_NEURAL_COUNTS_2);
    biases += uint(SLUICE_NEURAL_COUNTS_2);
    sluiceNeuralVectorLayer2(s, 2u, scales, biases, neurons);
    scales += uint(SLUICE_NEURAL_COUNTS_3);
    biases += uint(SLUICE_NEURAL_COUNTS_3);
    sluiceNeuralVectorLast(s, scales, biases, neurons, channels);
}
#else
/* Defines a function that returns the activations of a layer in 16-bit floats. */
#define SLUICE_NEURAL_VECTOR_FLOAT(name, K, M)                                                                       \
    void name(uint s, uint matrix, uint biases, coopvecNV<float16_t, K> inputs, out coopvecNV<float16_t, M> made)    \
    {                                                                                                                \
        coopVecMatMulAddNV(made, inputs, gl_ComponentTypeFloatE4M3NV, SLUICE_NEURAL_VECTOR_WEIGHTS(s),               \
                           SLUICE_NEURAL_WEIGHT_WORD(s, matrix), gl_ComponentTypeFloatE4M3NV,                        \
                           SLUICE_NEURAL_VECTOR_WEIGHTS(s), 4u * biases, gl_ComponentTypeFloat16NV, M, K,            \
                           gl_CooperativeVectorMatrixLayoutInferencingOptimalNV, false, 0);                          \
        SLUICE_NEURAL_UNROLL                                                                                         \
        for (int i = 0; i < M; i++)                                                                                  \
            made[i] = float16_t(sluiceNeuralActivation(float(made[i])));                                             \
    }

SLUICE_NEURAL_VECTOR_FLOAT(sluiceNeuralVectorLayer0, SLUICE_NEURAL_COUNTS_0, SLUICE_NEURAL_COUNTS_1)
SLUICE_NEURAL_VECTOR_FLOAT(sluiceNeuralVectorLayer1, SLUICE_NEURAL_COUNTS_1, SLUICE_NEURAL_COUNTS_2)
SLUICE_NEURAL_VECTOR_FLOAT(sluiceNeuralVectorLayer2, SLUICE_NEURAL_COUNTS_2, SLUICE_NEURAL_COUNTS_3)

/** Runs the network of a set on its inputs. Biases of layers 0 to 2 are half. */
void sluiceNeuralRunVector(uint s, float values[SLUICE_NEURAL_VALUES], out float channels[SLUICE_NEURAL_CHANNELS])
{
    coopvecNV<float16_t, SLUICE_NEURAL_COUNTS_0> inputs;
    coopvecNV<float16_t, SLUICE_NEURAL_COUNTS_1> first;
    coopvecNV<float16_t, SLUICE_NEURAL_COUNTS_2> second;
    coopvecNV<float16_t, SLUICE_NEURAL_COUNTS_3> third;
    uint neurons[SLUICE_NEURAL_WORDS], biases = SLUICE_NEURAL_VECTOR_HEAD;
    SLUICE_NEURAL_UNROLL
    for (int i = 0; i < SLUICE_NEURAL_COUNTS_0; i++)
        inputs[i] = float16_t(values[i]);
    sluiceNeuralVectorLayer0(s, 0u, biases, inputs, first);
    biases += uint(SLUICE_NEURAL_COUNTS_1 / 2);
    sluiceNeuralVectorLayer1(s, 1u, biases, first, second);
    biases += uint(SLUICE_NEURAL_COUNTS_2 / 2);
    sluiceNeuralVectorLayer2(s, 2u, biases, second, third);
    biases += uint(SLUICE_NEURAL_COUNTS_3 / 2);
    SLUICE_NEURAL_UNROLL
    for (int i = 0; i < SLUICE_NEURAL_COUNTS_3 / 4; i++) {
        neurons[i] = 0u;
        SLUICE_NEURAL_UNROLL
        for (int j = 0; j < 4; j++)
            neurons[i] |= sluiceNeuralActivationCode(float(third[4 * i + j])) << 8 * j;
    }
    sluiceNeuralVectorLast(s, biases, biases + 16u, neurons, channels);
}
#endif

#endif
