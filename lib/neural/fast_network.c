#include "neural/fast_network.h"

#include "base/little_endian.h"
#include "image/half.h"

#include <string.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

enum { LAST = SLUICE_NEURAL_LAYERS - 1, GROUP = 16 };

/* Elements are floats and comparisons give all bits. */
typedef float four __attribute__((vector_size(16)));
typedef int32_t four_ints __attribute__((vector_size(16)));

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

/* Sums of 16 outputs. `pairs` inputs of 16 bits lie behind one another. */
static void sum_group(const int16_t *weights, const int32_t *biases, const int16_t *inputs,
                      uint32_t count, four_ints sums[4])
{
    memcpy(sums, biases, 4 * sizeof *sums);
#if defined(__SSE2__)
    __m128i s[4];
    for (int b = 0; b < 4; b++)
        s[b] = (__m128i)sums[b];
    for (uint32_t i = 0; i < count; i += 2) {
        int32_t pair;
        memcpy(&pair, inputs + i, sizeof pair);
        __m128i in = _mm_set1_epi32(pair);
        for (uint32_t b = 0; b < 4; b++) {
            const int16_t *w = weights + (size_t)b * 4 * count + 4 * (size_t)i;
            s[b] = _mm_add_epi32(
                s[b], _mm_madd_epi16(_mm_load_si128((const __m128i *)(const void *)w), in));
        }
    }
    for (int b = 0; b < 4; b++)
        sums[b] = (four_ints)s[b];
#else
    for (uint32_t b = 0; b < 4; b++)
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t o = 0; o < 4; o++) {
                int32_t w = weights[b * 4 * count + i / 2 * 8 + o * 2 + i % 2];
                sums[b][o] = (int32_t)((uint32_t)sums[b][o] + (uint32_t)(w * inputs[i]));
            }
#endif
}

static four select_less(four a, four b, four yes, four no)
{
    four_ints mask = a < b;
    return (four)(((four_ints)yes & mask) | ((four_ints)no & ~mask));
}

static four activate(four r)
{
    const four zero = {0}, one = zero + 1.0f, three = zero + 3.0f;
    four t = r * 0.333333f + 0.5f;
    t = select_less(t, zero, zero, select_less(one, t, one, t));
    return select_less(r, three, r, three) * t;
}

/* The nearest integers, ties to even. Values are -15 to 240: adding 1.5 * 2^23 rounds them. */
static four_ints round_even(four value)
{
    four shifted = value + 12582912.0f;
    return (four_ints)shifted - 0x4B400000;
}

static void store_codes(four y, int16_t *codes)
{
    four_ints code = round_even(y * 80.0f) - 113;
    for (int o = 0; o < 4; o++)
        codes[o] = (int16_t)code[o];
}

static four load(const float *floats)
{
    four f;
    memcpy(&f, floats, sizeof f);
    return f;
}

static four to_floats(four_ints i)
{
#if defined(__SSE2__)
    return (four)_mm_cvtepi32_ps((__m128i)i);
#else
    return (four){(float)i[0], (float)i[1], (float)i[2], (float)i[3]};
#endif
}

/* An INT8 layer. `codes` NULL: the last one, whose values go to `outputs`. */
static void int8_layer(const struct slc_neural_fast *fast, uint32_t layer, const int16_t *inputs,
                       int16_t *codes, float *outputs)
{
    uint32_t count = fast->shape.inputs[layer];
    for (uint32_t o = 0; o < fast->shape.outputs[layer]; o += GROUP) {
        uint32_t first = fast->first_output[layer] + o;
        four_ints sums[4];
        sum_group(fast->weights + fast->first_weight[layer] + (size_t)o * count,
                  fast->biases + first, inputs, count, sums);
        for (uint32_t b = 0; b < 4; b++) {
            four r = to_floats(sums[b]) * load(fast->scales + first + 4 * b);
            if (codes)
                store_codes(activate(r), codes + o + 4 * b);
            else
                memcpy(outputs + o + 4 * b, &r, sizeof r);
        }
    }
}

void slc_neural_fast_int8(const struct slc_neural_fast *fast, const int8_t *inputs, float *outputs)
{
    int16_t neurons[2][SLC_NEURAL_MAX_INPUTS];
    for (uint32_t i = 0; i < fast->shape.inputs[0]; i++)
        neurons[0][i] = inputs[i];
    for (uint32_t layer = 0; layer < LAST; layer++)
        int8_layer(fast, layer, neurons[layer % 2], neurons[(layer + 1) % 2], NULL);
    int8_layer(fast, LAST, neurons[LAST % 2], NULL, outputs);
}

/* Sums have the order of the inputs, behind the bias. */
static void fp8_layer(const struct slc_neural_fast *fast, uint32_t layer, const float *inputs,
                      float *made)
{
    uint32_t outputs = fast->shape.outputs[layer];
    const float *weights = fast->floats + fast->first_weight[layer];
    for (uint32_t o = 0; o < outputs; o += GROUP) {
        four sums[4];
        memcpy(sums, fast->float_biases + fast->first_output[layer] + o, sizeof sums);
        for (uint32_t i = 0; i < fast->shape.inputs[layer]; i++)
            for (uint32_t b = 0; b < 4; b++)
                sums[b] += load(weights + (size_t)i * outputs + o + 4 * b) * inputs[i];
        for (uint32_t b = 0; b < 4; b++) {
            four y = activate(sums[b]);
            memcpy(made + o + 4 * b, &y, sizeof y);
        }
    }
}

/* As slc_e4m3_from_float and back, without the code between. */
static float round_to_e4m3(float value)
{
    uint32_t bits = slc_float_bits(value), sign = bits & 0x80000000u;
    float magnitude = slc_float_from_bits(bits ^ sign);
    if (!(magnitude < 448.0f))
        magnitude = 448.0f;
    else if (magnitude < 0x1p-6f) /* a multiple of 2^-9, which the addition rounds to */
        magnitude = (magnitude + 0x1p14f) - 0x1p14f;
    else
        magnitude = slc_float_from_bits(((bits ^ sign) + 0x7FFFF + (bits >> 20 & 1)) & ~0xFFFFFu);
    return slc_float_from_bits(slc_float_bits(magnitude) | sign);
}

void slc_neural_fast_fp8(const struct slc_neural_fast *fast, const float *inputs, float *outputs)
{
    float values[SLC_NEURAL_MAX_INPUTS], made[SLC_NEURAL_MAX_NEURONS];
    int16_t codes[SLC_NEURAL_MAX_NEURONS];
    for (uint32_t i = 0; i < fast->shape.inputs[0]; i++)
        values[i] = round_to_e4m3(slc_float_from_half(slc_half_from_float(inputs[i])));
    for (uint32_t layer = 0; layer < LAST; layer++) {
        fp8_layer(fast, layer, values, made);
        for (uint32_t o = 0; layer + 1 < LAST && o < fast->shape.outputs[layer]; o++)
            values[o] = round_to_e4m3(made[o]);
    }
    for (uint32_t o = 0; o < fast->shape.inputs[LAST]; o += 4)
        store_codes(load(made + o), codes + o);
    int8_layer(fast, LAST, codes, NULL, outputs);
}
