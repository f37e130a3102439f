#include "base/little_endian.h"
#include "image/half.h"
#include "neural/decoder.h"

#include <math.h>
#include <string.h>

enum { LAST = SLUICE_NEURAL_LAYERS - 1 };

/* Activation: a cubic GELU, clamped to 3. Constants are part of the format. */
static float activate(float r)
{
    float t = r * 0.333333f + 0.5f;
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    return (r < 3.0f ? r : 3.0f) * t;
}

/* Converts values in -0.1875..3 to codes -128..127. */
static int8_t activation_code(float y)
{
    return (int8_t)((int32_t)rintf(y * 80.0f) - 113);
}

/* Computes an output. Sums wrap like shaders', so a hostile bias cannot cause undefined behavior.
 */
static float int8_output(const uint8_t *weights, const struct slc_neural_blob *at, uint32_t layer,
                         uint32_t output, uint32_t count, const int8_t *inputs)
{
    const int8_t *row = (const int8_t *)weights + at->weights[layer] + (size_t)output * count;
    uint32_t sum = slc_get_u32(weights + at->biases[layer] + 4 * output);
    for (uint32_t i = 0; i < count; i++)
        sum += (uint32_t)(row[i] * inputs[i]);
    uint32_t scale = slc_get_u32(weights + at->scales[layer] + 4 * output);
    return (float)(int32_t)sum * slc_float_from_bits(scale);
}

void slc_neural_run_int8(const struct slc_neural_shape *shape, const struct slc_neural_blob *at,
                         const uint8_t *weights, const int8_t *inputs, float *outputs)
{
    int8_t neurons[2][SLC_NEURAL_MAX_NEURONS];
    for (uint32_t i = 0; i < LAST; i++) {
        int8_t *to = neurons[i % 2];
        for (uint32_t o = 0; o < shape->outputs[i]; o++)
            to[o] =
                activation_code(activate(int8_output(weights, at, i, o, shape->inputs[i], inputs)));
        inputs = to;
    }
    for (uint32_t o = 0; o < shape->outputs[LAST]; o++)
        outputs[o] = int8_output(weights, at, LAST, o, shape->inputs[LAST], inputs);
}

float slc_float_from_e4m3(uint8_t bits)
{
    uint32_t exponent = bits >> 3 & 15, mantissa = bits & 7;
    float value =
        exponent ? ldexpf((float)(8 + mantissa), (int)exponent - 10) : (float)mantissa * 0x1p-9f;
    return bits & 0x80 ? -value : value;
}

uint8_t slc_e4m3_from_float(float value)
{
    uint32_t bits = slc_float_bits(value), sign = bits >> 24 & 0x80;
    float magnitude = slc_float_from_bits(bits & 0x7FFFFFFF);
    if (!(magnitude < 448.0f))
        return (uint8_t)(sign | 0x7E);
    if (magnitude < 0x1p-6f)
        return (uint8_t)(sign | (uint32_t)rintf(magnitude * 0x1p9f)); /* 8 is the first normal */
    bits = (bits & 0x7FFFFFFF) - (120u << 23);                        /* bias 127 to 7 */
    bits += 0x7FFFF + (bits >> 20 & 1);
    return (uint8_t)(sign | bits >> 20);
}

static float round_to_e4m3(float value)
{
    return slc_float_from_e4m3(slc_e4m3_from_float(value));
}

static float fp8_output(const uint8_t *weights, const struct slc_neural_blob *at, uint32_t layer,
                        uint32_t output, uint32_t count, const float *inputs)
{
    const uint8_t *row = weights + at->weights[layer] + (size_t)output * count;
    const uint8_t *bias = weights + at->biases[layer] + 2 * output;
    float sum = slc_float_from_half((uint16_t)(bias[0] | bias[1] << 8));
    for (uint32_t i = 0; i < count; i++)
        sum += inputs[i] * slc_float_from_e4m3(row[i]);
    return sum;
}

void slc_neural_run_fp8(const struct slc_neural_shape *shape, const struct slc_neural_blob *at,
                        const uint8_t *weights, const float *inputs, float *outputs)
{
    float values[SLC_NEURAL_MAX_INPUTS], made[SLC_NEURAL_MAX_NEURONS];
    int8_t codes[SLC_NEURAL_MAX_NEURONS];
    for (uint32_t i = 0; i < shape->inputs[0]; i++)
        values[i] = round_to_e4m3(slc_float_from_half(slc_half_from_float(inputs[i])));
    for (uint32_t i = 0; i < LAST; i++) {
        for (uint32_t o = 0; o < shape->outputs[i]; o++)
            made[o] = activate(fp8_output(weights, at, i, o, shape->inputs[i], values));
        for (uint32_t o = 0; o < shape->outputs[i]; o++)
            values[o] = round_to_e4m3(made[o]);
    }
    for (uint32_t o = 0; o < shape->inputs[LAST]; o++)
        codes[o] = activation_code(made[o]);
    for (uint32_t o = 0; o < shape->outputs[LAST]; o++)
        outputs[o] = int8_output(weights, at, LAST, o, shape->inputs[LAST], codes);
}
