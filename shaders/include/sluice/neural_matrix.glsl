/*
 * Decodes a texel per invocation of a subgroup with VK_KHR_cooperative_matrix: all texels of a subgroup are the
 * columns of one matrix product per layer. For compute shaders. Includes neural.glsl, so define what that needs,
 * with INT8 weights, and besides:
 *
 *     #define SLUICE_NEURAL_MATRIX_WEIGHTS(s) weights // array of uint in a storage buffer: sluiceGetNeuralWeights (INT8)
 *     #define SLUICE_NEURAL_MATRIX_FIRST(s) 0u        // its word where the weights of a set begin, a multiple of 4
 *     #define SLUICE_NEURAL_GROUP 64                  // invocations of a workgroup, a multiple of the subgroup's
 *     #define SLUICE_NEURAL_MATRIX_M 16               // shape that the device lists for int8 products with int32
 *     #define SLUICE_NEURAL_MATRIX_N 16               // sums (sluiceGetNeuralPaths); these three may be
 *     #define SLUICE_NEURAL_MATRIX_K 32               // specialization constants. The subgroup is a multiple of N.
 *
 * Needs a compiler with GL_KHR_cooperative_matrix, and `#pragma use_vulkan_memory_model` before. Sums are exact,
 * so results are the bits of sluiceNeuralSample. Takes 192 bytes of shared memory per invocation.
 */
#ifndef SLUICE_NEURAL_MATRIX_GLSL
#define SLUICE_NEURAL_MATRIX_GLSL

#extension GL_KHR_cooperative_matrix : require
#extension GL_KHR_memory_scope_semantics : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_EXT_shader_explicit_arithmetic_types : require

#include "neural.glsl"

/* Words between texels in shared memory: inputs are at most 96 bytes, sums at most 16. Multiples of 16 bytes, which
 * are not multiples of all banks. */
#define SLUICE_NEURAL_INPUT_PITCH 28
#define SLUICE_NEURAL_SUM_PITCH 20

shared uint sluiceNeuralSharedInputs[SLUICE_NEURAL_GROUP * SLUICE_NEURAL_INPUT_PITCH];
shared int sluiceNeuralSharedSums[SLUICE_NEURAL_GROUP * SLUICE_NEURAL_SUM_PITCH];

/** Computes M sums of a layer, without biases, for all texels of the subgroup, from output `row` on. */
void sluiceNeuralMatrixSums(uint s, SluiceNeuralLayer layer, uint row, uint firstTexel)
{
    const uint m = uint(SLUICE_NEURAL_MATRIX_M), n = uint(SLUICE_NEURAL_MATRIX_N), k = uint(SLUICE_NEURAL_MATRIX_K);
    for (uint column = 0u; column < gl_SubgroupSize; column += n) {
        coopmat<int32_t, gl_ScopeSubgroup, SLUICE_NEURAL_MATRIX_M, SLUICE_NEURAL_MATRIX_N, gl_MatrixUseAccumulator>
            sums = coopmat<int32_t, gl_ScopeSubgroup, SLUICE_NEURAL_MATRIX_M, SLUICE_NEURAL_MATRIX_N,
                           gl_MatrixUseAccumulator>(0);
        uint texel = firstTexel + column;
        for (uint word = 0u; word < layer.inputWords; word += k / 4u) {
            coopmat<int8_t, gl_ScopeSubgroup, SLUICE_NEURAL_MATRIX_M, SLUICE_NEURAL_MATRIX_K, gl_MatrixUseA> a;
            coopmat<int8_t, gl_ScopeSubgroup, SLUICE_NEURAL_MATRIX_K, SLUICE_NEURAL_MATRIX_N, gl_MatrixUseB> b;
            /* Beyond the inputs of a layer `a` has other numbers, and `b` zeros. */
            coopMatLoad(a, SLUICE_NEURAL_MATRIX_WEIGHTS(s),
                        SLUICE_NEURAL_MATRIX_FIRST(s) + layer.weights + row * layer.inputWords + word,
                        layer.inputWords, gl_CooperativeMatrixLayoutRowMajor);
            coopMatLoad(b, sluiceNeuralSharedInputs, texel * SLUICE_NEURAL_INPUT_PITCH + word,
                        SLUICE_NEURAL_INPUT_PITCH, gl_CooperativeMatrixLayoutColumnMajor);
            sums = coopMatMulAdd(a, b, sums);
        }
        coopMatStore(sums, sluiceNeuralSharedSums, texel * SLUICE_NEURAL_SUM_PITCH, SLUICE_NEURAL_SUM_PITCH,
                     gl_CooperativeMatrixLayoutColumnMajor);
    }
}

/** Returns a scaled sum of this invocation's texel. */
float sluiceNeuralMatrixOutput(uint s, SluiceNeuralLayer layer, uint row, uint i, uint texel)
{
    int sum = sluiceNeuralSharedSums[texel * SLUICE_NEURAL_SUM_PITCH + i];
    return sluiceNeuralScaled(s, sum + int(SLUICE_NEURAL_WEIGHT_WORD(s, layer.biases + row + i)),
                              layer.scales + row + i);
}

/** Replaces the inputs of a hidden layer by its outputs, and inputs behind them by 0. */
void sluiceNeuralMatrixHidden(uint s, SluiceNeuralLayer layer, uint firstTexel, uint texel)
{
    uint made[16];
    for (uint i = 0u; i < 16u; i++)
        made[i] = 0u;
    for (uint row = 0u; row < layer.outputs; row += uint(SLUICE_NEURAL_MATRIX_M)) {
        sluiceNeuralMatrixSums(s, layer, row, firstTexel);
        subgroupBarrier();
        for (uint i = 0u; i < uint(SLUICE_NEURAL_MATRIX_M); i++)
            made[(row + i) / 4u] |= sluiceNeuralActivate(sluiceNeuralMatrixOutput(s, layer, row, i, texel))
                                    << 8u * (i & 3u);
        subgroupBarrier();
    }
    for (uint i = 0u; i < 16u; i++)
        sluiceNeuralSharedInputs[texel * SLUICE_NEURAL_INPUT_PITCH + i] = made[i];
    subgroupBarrier();
}

/** Runs the network on the inputs that all invocations of the subgroup have written. */
void sluiceNeuralRunMatrix(uint s, uint firstTexel, uint texel, out float channels[SLUICE_NEURAL_CHANNELS])
{
    bool isSchema1 = SLUICE_NEURAL_IS_SCHEMA_1(s);
    uvec4 inputs = isSchema1 ? uvec4(SLUICE_NEURAL_INPUT_COUNT(s), 64u, 64u, 64u) : uvec4(48u, 64u, 48u, 32u);
    uvec4 outputs = uvec4(inputs.yzw, 16u), words = inputs * outputs / 4u;
    SluiceNeuralLayer layer;
    layer.weights = 0u;
    layer.scales = words.x + words.y + words.z + words.w;
    layer.biases = layer.scales + outputs.x + outputs.y + outputs.z + outputs.w;
    for (uint i = 0u; i < 4u; i++) {
        layer.inputWords = inputs[i] / 4u;
        layer.outputs = outputs[i];
        if (i < 3u)
            sluiceNeuralMatrixHidden(s, layer, firstTexel, texel);
        else
            for (uint row = 0u; row < 16u; row += uint(SLUICE_NEURAL_MATRIX_M)) {
                sluiceNeuralMatrixSums(s, layer, row, firstTexel);
                subgroupBarrier();
                for (uint o = 0u; o < uint(SLUICE_NEURAL_MATRIX_M); o++)
                    channels[row + o] = sluiceNeuralMatrixOutput(s, layer, row, o, texel);
                subgroupBarrier();
            }
        layer.weights += words[i];
        layer.scales += outputs[i];
        layer.biases += outputs[i];
    }
}

/**
 * Decodes a texel of a mip per invocation, as sluiceNeuralSample. Call it in flow that is uniform in the
 * subgroup, with the same set `s` in all its invocations; texel and mip may differ. Invocations without a texel
 * call it with one outside.
 */
bool sluiceNeuralSampleSubgroup(uint s, ivec2 texel, uint mip, out float channels[SLUICE_NEURAL_CHANNELS])
{
    uint inputs[SLUICE_NEURAL_WORDS];
    uint firstTexel = gl_SubgroupID * gl_SubgroupSize, own = firstTexel + gl_SubgroupInvocationID;
    bool resident = mip < sluiceGetNeuralMipCount(s) && all(greaterThanEqual(texel, ivec2(0))) &&
                    all(lessThan(uvec2(texel), sluiceGetNeuralSize(s, mip)));
    if (resident)
        resident = sluiceNeuralInputs(s, uvec2(texel), mip, sluiceGetNeuralSize(s, mip), inputs);
    uint words = (SLUICE_NEURAL_IS_SCHEMA_1(s) ? SLUICE_NEURAL_INPUT_COUNT(s) : 48u) / 4u;
    subgroupBarrier();
    for (uint i = 0u; i < uint(SLUICE_NEURAL_INPUT_PITCH); i++)
        sluiceNeuralSharedInputs[own * SLUICE_NEURAL_INPUT_PITCH + i] = resident && i < words ? inputs[i] : 0u;
    subgroupBarrier();
    sluiceNeuralRunMatrix(s, firstTexel, own, channels);
    if (!resident)
        for (uint i = 0u; i < SLUICE_NEURAL_CHANNELS; i++)
            channels[i] = 0.0;
    return resident;
}

#endif
