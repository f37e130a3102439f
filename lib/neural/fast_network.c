#include "neural/fast_network.h"

#include "base/little_endian.h"
#include "image/half.h"

enum { LAST = SLUICE_NEURAL_LAYERS - 1 };

static bool is_fp8(const struct slc_neural_fast *fast, uint32_t layer)
{
    return fast->kind == SLUICE_NEURAL_WEIGHTS_FP8 && layer < LAST;
}

static void order_layer(struct slc_neural_fast *fast, const struct slc_neural_blob *at,
                        const uint8_t *blob, const float e4m3[256], uint32_t layer)
{
    uint32_t inputs = fast->shape.inputs[layer], outputs = fast->shape.outputs[layer];
    const uint8_t *row = blob + at->weights[layer];
    for (uint32_t o = 0; o < outputs; o++)
        for (uint32_t i = 0; i < inputs; i++) {
            uint8_t weight = row[(size_t)o * inputs + i];
            uint32_t first = fast->first_weight[layer];
            if (is_fp8(fast, layer))
                fast->floats[first + i * outputs + o] = e4m3[weight];
            else
                fast->weights[first + o / 4 * 4 * inputs + i / 2 * 8 + o % 4 * 2 + i % 2] =
                    (int8_t)weight;
        }
    for (uint32_t o = 0; o < outputs; o++) {
        uint32_t to = fast->first_output[layer] + o;
        const uint8_t *half = blob + at->biases[layer] + 2 * (size_t)o;
        if (is_fp8(fast, layer)) {
            fast->float_biases[to] = slc_float_from_half((uint16_t)(half[0] | half[1] << 8));
            continue;
        }
        fast->scales[to] =
            slc_float_from_bits(slc_get_u32(blob + at->scales[layer] + 4 * (size_t)o));
        fast->biases[to] = (int32_t)slc_get_u32(blob + at->biases[layer] + 4 * (size_t)o);
    }
}

void slc_neural_fast_init(struct slc_neural_fast *fast, const struct slc_neural_shape *shape,
                          SluiceNeuralWeightKind kind, const uint8_t *blob)
{
    struct slc_neural_blob at = slc_neural_blob_of(shape, kind);
    uint32_t weight = 0, output = 0;
    float e4m3[256];
    fast->shape = *shape;
    fast->kind = kind;
    for (uint32_t i = 0; i < 256; i++)
        e4m3[i] = slc_float_from_e4m3((uint8_t)i);
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        fast->first_weight[i] = weight;
        fast->first_output[i] = output;
        order_layer(fast, &at, blob, e4m3, i);
        weight += shape->inputs[i] * shape->outputs[i];
        output += shape->outputs[i];
    }
}
