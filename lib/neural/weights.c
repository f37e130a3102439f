#include "base/checked.h"
#include "base/little_endian.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "image/half.h"
#include "neural/decoder.h"

#include <math.h>
#include <string.h>

enum { LAST = SLUICE_NEURAL_LAYERS - 1 };

static SluiceResult check_outputs(const SluiceNeuralSet *set, const SluiceNeuralOutput *outputs)
{
    for (uint32_t i = 0; outputs && i < SLUICE_NEURAL_MAX_CHANNELS; i++) {
        const SluiceNeuralOutput *output = &outputs[i];
        if (output->channel == SLUICE_NEURAL_CONSTANT) {
            if (!(fabsf(output->constant) < 32768))
                return slc_log_refusal(&set->file.log,
                                       "%s: constant of output %u is %g; below 32768 is possible",
                                       set->file.path, i, (double)output->constant);
        } else if (output->channel >= SLUICE_NEURAL_MAX_CHANNELS) {
            return slc_log_refusal(&set->file.log,
                                   "%s: channel of output %u is %u; 0 to 15 are possible",
                                   set->file.path, i, output->channel);
        }
    }
    return SLUICE_SUCCESS;
}

/* Reorders the rows of the last layer, or makes rows from constants. */
static void map_outputs(const SluiceNeuralSet *set, const struct slc_neural_blob *stored,
                        const struct slc_neural_blob *at, const uint8_t *from,
                        const SluiceNeuralOutput *outputs, uint8_t *to)
{
    uint32_t inputs = set->shape.inputs[LAST];
    for (uint32_t i = 0; i < SLUICE_NEURAL_MAX_CHANNELS; i++) {
        uint32_t row = outputs[i].channel;
        uint8_t *weights = to + at->weights[LAST] + (size_t)i * inputs;
        uint8_t *scale = to + at->scales[LAST] + 4 * i, *bias = to + at->biases[LAST] + 4 * i;
        if (row == SLUICE_NEURAL_CONSTANT) {
            memset(weights, 0, inputs);
            slc_put_u32(scale, slc_float_bits(0x1p-16f));
            slc_put_u32(bias, (uint32_t)(int32_t)rintf(outputs[i].constant * 65536.0f));
        } else {
            memcpy(weights, from + stored->weights[LAST] + (size_t)row * inputs, inputs);
            memcpy(scale, from + stored->scales[LAST] + 4 * row, 4);
            memcpy(bias, from + stored->biases[LAST] + 4 * row, 4);
        }
    }
}

/* Converts E4M3 weights to half, without loss. Scales and biases keep their order. */
static void widen_weights(const struct slc_neural_blob *from, const struct slc_neural_blob *at,
                          const uint8_t *fp8, uint8_t *to)
{
    for (uint32_t i = 0; i < from->weights[LAST]; i++) {
        uint16_t half = slc_half_from_float(slc_float_from_e4m3(fp8[i]));
        to[2 * i] = (uint8_t)half;
        to[2 * i + 1] = (uint8_t)(half >> 8);
    }
    memcpy(to + at->weights[LAST], fp8 + from->weights[LAST], from->size - from->weights[LAST]);
}

SluiceResult sluiceGetNeuralWeights(const SluiceNeuralSet *set, SluiceNeuralWeightKind kind,
                                    const SluiceNeuralOutput *pOutputs, uint64_t *pSize,
                                    void *pBytes)
{
    if (!set || !pSize)
        return SLUICE_ERROR_NULL_POINTER;
    if (kind != SLUICE_NEURAL_WEIGHTS_INT8 && kind != SLUICE_NEURAL_WEIGHTS_FP8 &&
        kind != SLUICE_NEURAL_WEIGHTS_HALF)
        return slc_log_refusal(&set->file.log, "%s: kind of weights is %d; 0 to 2 are possible",
                               set->file.path, (int)kind);
    SluiceNeuralWeightKind stored =
        kind == SLUICE_NEURAL_WEIGHTS_HALF ? SLUICE_NEURAL_WEIGHTS_FP8 : kind;
    SluiceResult result = check_outputs(set, pOutputs);
    if (result != SLUICE_SUCCESS)
        return result;
    const uint8_t *blob = set->weights[stored];
    if (!blob)
        return slc_input_fail(&set->file, SLUICE_ERROR_UNSUPPORTED, "has no %s weights",
                              stored == SLUICE_NEURAL_WEIGHTS_FP8 ? "FP8" : "INT8");
    struct slc_neural_blob from = slc_neural_blob_of(&set->shape, stored);
    struct slc_neural_blob at = slc_neural_blob_of(&set->shape, kind);
    uint64_t room = *pSize;
    *pSize = at.size;
    if (!pBytes)
        return SLUICE_SUCCESS;
    if (room < at.size)
        return SLUICE_ERROR_SIZE_MISMATCH;
    if (kind == stored)
        memcpy(pBytes, blob, at.size);
    else
        widen_weights(&from, &at, blob, pBytes);
    if (pOutputs)
        map_outputs(set, &from, &at, blob, pOutputs, pBytes);
    return SLUICE_SUCCESS;
}
