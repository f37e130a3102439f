#include "neural_train/trained_network.h"

#include "image/half.h"

#include <math.h>

#define LAYERS 4
#define CODE_STEP 80.0 /* hidden codes are y * 80 - 113 */
#define CODE_OFFSET 113
#define INPUT_STEP 127.5 /* codes of inputs are x * 127.5 */
#define MAX_BIAS 1e9     /* largest bias that leaves room for 64 products of codes */

static const struct layer {
    uint32_t inputs, outputs, weights, first_row;
} layers[LAYERS] = {{48, 64, TRAIN_WEIGHTS0, 0},
                    {64, 48, TRAIN_WEIGHTS1, 64},
                    {48, 32, TRAIN_WEIGHTS2, 112},
                    {32, 16, TRAIN_WEIGHTS3, 144}};

uint32_t slc_train_hash(uint32_t x)
{
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
    return (x >> 22) ^ x;
}

float slc_train_unit_float(uint32_t bits)
{
    return (float)(bits >> 8) * (1.0f / 16777216.0f);
}

void slc_network_init(float *parameters, uint32_t seed)
{
    for (uint32_t l = 0; l < LAYERS; l++) {
        /* He et al., "Delving Deep into Rectifiers" (2015), uniform. */
        float limit = sqrtf(6.0f / (float)layers[l].inputs);
        for (uint32_t i = 0; i < layers[l].inputs * layers[l].outputs; i++) {
            uint32_t at = layers[l].weights + i;
            float unit = slc_train_unit_float(slc_train_hash(at + slc_train_hash(seed)));
            parameters[at] = limit * (2.0f * unit - 1.0f);
        }
    }
    for (uint32_t row = 0; row < TRAIN_ROWS; row++)
        parameters[TRAIN_BIASES + row] = 0.0f;
}

/* Replaces NaN, the result of diverged training, because integers have no NaN. */
static float finite(float value)
{
    return isfinite(value) ? value : 0.0f;
}

/* Computes bias and scale of a row with inputs (code + offset) / step. */
static void fold_row(const float *weights, uint32_t count, float bias, double step, int offset,
                     int8_t *codes, float *scale, int32_t *folded)
{
    float most = 1e-20f;
    for (uint32_t i = 0; i < count; i++)
        most = fmaxf(most, fabsf(finite(weights[i])));
    bias = finite(bias);
    /* A bias far above all weights determines the unit instead, so that the bias fits. */
    float unit = fmaxf(most / 127.0f, fabsf(bias) * (float)(step / MAX_BIAS));
    int sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        codes[i] = (int8_t)rintf(finite(weights[i]) / unit);
        sum += codes[i];
    }
    double wanted = offset * sum + bias * step / (double)unit;
    *scale = (float)(unit / step);
    *folded = (int32_t)rint(wanted);
}

static void fold_layer(const float *parameters, uint32_t l, int8_t *codes, float *scales,
                       int32_t *biases)
{
    const struct layer *layer = &layers[l];
    for (uint32_t o = 0; o < layer->outputs; o++)
        fold_row(parameters + layer->weights + (size_t)o * layer->inputs, layer->inputs,
                 parameters[TRAIN_BIASES + layer->first_row + o], l ? CODE_STEP : INPUT_STEP,
                 l ? CODE_OFFSET : 0, codes + (size_t)o * layer->inputs, scales + o, biases + o);
}

void slc_network_to_int8(const float *parameters, struct slc_int8_network *network)
{
    for (uint32_t l = 0; l < LAYERS; l++)
        fold_layer(parameters, l, network->weights + layers[l].weights,
                   network->scales + layers[l].first_row, network->biases + layers[l].first_row);
}

uint8_t slc_train_e4m3(float value)
{
    float size = fminf(fabsf(value), 448.0f);
    int exponent;
    frexpf(size, &exponent); /* size = 0.5..1 * 2^exponent */
    int power = size < 0x1p-6f ? -6 : exponent - 1;
    int steps = (int)rintf(ldexpf(size, 3 - power)); /* 8 to 16; below 8 if subnormal */
    int code = size < 0x1p-6f ? steps : ((power + 7) << 3) + steps - 8;
    return (uint8_t)((value < 0.0f ? 0x80 : 0) | code);
}

void slc_network_to_fp8(const float *parameters, struct slc_fp8_network *network)
{
    for (uint32_t i = 0; i < TRAIN_WEIGHTS3; i++)
        network->weights[i] = slc_train_e4m3(parameters[i]);
    for (uint32_t row = 0; row < TRAIN_ROWS - TRAIN_OUTPUTS; row++)
        network->biases[row] = slc_half_from_float(parameters[TRAIN_BIASES + row]);
    fold_layer(parameters, LAYERS - 1, (int8_t *)network->weights + TRAIN_WEIGHTS3, network->scales,
               network->last_biases);
}
