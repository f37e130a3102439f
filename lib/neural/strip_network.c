#include "neural/strip_lanes.h"

#include <string.h>

enum { LAST = SLUICE_NEURAL_LAYERS - 1 };

static int32_t weight_pair(const int16_t *weights)
{
    return (int32_t)((uint32_t)(uint16_t)weights[0] | (uint32_t)weights[1] << 16);
}

/* Computes the sums of four outputs. Sums wrap. */
static inline void sum_four(const int16_t *weights, const int32_t *biases, const slc_words *pairs,
                            uint32_t count, slc_words sums[4])
{
    const slc_words zero = {0};
    for (int k = 0; k < 4; k++)
        sums[k] = zero + (uint32_t)biases[k];
    for (uint32_t i = 0; i < count / 2; i++, weights += 8)
        for (int k = 0; k < 4; k++)
            sums[k] += multiply_pairs(pairs[i], zero + (uint32_t)weight_pair(weights + 2 * k));
}

/* Computes four outputs from `o` on, before the activation. */
static inline void int8_four(const struct slc_neural_fast *fast, uint32_t layer, uint32_t o,
                             const slc_words *pairs, slc_floats values[4])
{
    const uint32_t count = fast->shape.inputs[layer], first = fast->first_output[layer] + o;
    slc_words sums[4];
    sum_four(fast->weights + fast->first_weight[layer] + (size_t)o * count, fast->biases + first,
             pairs, count, sums);
    for (uint32_t k = 0; k < 4; k++)
        values[k] =
            __builtin_convertvector((slc_ints)sums[k], slc_floats) * fast->scales[first + k];
}

static void last_layer(const struct slc_neural_fast *fast, const slc_words *pairs,
                       slc_floats *outputs)
{
    for (uint32_t o = 0; o < fast->shape.outputs[LAST]; o += 4)
        int8_four(fast, LAST, o, pairs, outputs + o);
}

void slc_strip_run_int8(const struct slc_neural_fast *fast, slc_words *pairs, slc_floats *outputs)
{
    slc_words made[SLC_NEURAL_MAX_NEURONS / 2];
    for (uint32_t layer = 0; layer < LAST; layer++) {
        for (uint32_t o = 0; o < fast->shape.outputs[layer]; o += 4) {
            slc_floats values[4];
            int8_four(fast, layer, o, pairs, values);
            for (uint32_t k = 0; k < 4; k += 2)
                made[(o + k) / 2] = (codes_of(activate_lanes(values[k])) & 0xFFFF) |
                                    codes_of(activate_lanes(values[k + 1])) << 16;
        }
        memcpy(pairs, made, fast->shape.outputs[layer] / 2 * sizeof *pairs);
    }
    last_layer(fast, pairs, outputs);
}

/* Computes four outputs. Sums start with the bias, then add inputs in order. */
static inline void fp8_four(const struct slc_neural_fast *fast, uint32_t layer, uint32_t o,
                            const slc_floats *values, slc_floats made[4])
{
    const uint32_t outputs = fast->shape.outputs[layer];
    const float *weights = fast->floats + fast->first_weight[layer] + o;
    const float *biases = fast->float_biases + fast->first_output[layer] + o;
    slc_floats sums[4];
    for (int k = 0; k < 4; k++)
        sums[k] = (slc_floats){0} + biases[k];
    for (uint32_t i = 0; i < fast->shape.inputs[layer]; i++, weights += outputs)
        for (int k = 0; k < 4; k++)
            sums[k] += weights[k] * values[i];
    for (int k = 0; k < 4; k++)
        made[k] = activate_lanes(sums[k]);
}

void slc_strip_run_fp8(const struct slc_neural_fast *fast, slc_floats *values, slc_floats *outputs)
{
    slc_floats made[SLC_NEURAL_MAX_NEURONS];
    slc_words pairs[SLC_NEURAL_MAX_NEURONS / 2];
    for (uint32_t layer = 0; layer < LAST; layer++) {
        for (uint32_t o = 0; o < fast->shape.outputs[layer]; o += 4)
            fp8_four(fast, layer, o, values, made + o);
        for (uint32_t o = 0; layer + 1 < LAST && o < fast->shape.outputs[layer]; o++)
            values[o] = round_to_e4m3(made[o]);
    }
    for (uint32_t o = 0; o < fast->shape.inputs[LAST]; o += 2)
        pairs[o / 2] = (codes_of(made[o]) & 0xFFFF) | codes_of(made[o + 1]) << 16;
    last_layer(fast, pairs, outputs);
}

static void decode_row(const struct slc_neural_fast *fast, const struct slc_neural_strip *strip,
                       uint32_t y, slc_floats *outputs)
{
    if (fast->kind == SLUICE_NEURAL_WEIGHTS_INT8) {
        slc_words pairs[SLC_NEURAL_MAX_INPUTS / 2];
        slc_strip_int8_inputs(strip, y, pairs);
        slc_strip_run_int8(fast, pairs, outputs);
    } else {
        slc_floats values[SLC_NEURAL_MAX_INPUTS];
        slc_strip_fp8_inputs(strip, y, values);
        slc_strip_run_fp8(fast, values, outputs);
    }
}

static void decode_strip(const struct slc_neural_job *job, const struct slc_neural_fast *fast,
                         uint32_t x, uint32_t count)
{
    struct slc_neural_strip strip;
    slc_strip_init(&strip, job->view, job->x + x, count);
    for (uint32_t y = 0; y < job->height; y++) {
        slc_floats outputs[SLUICE_NEURAL_MAX_CHANNELS];
        float *texel = job->texels + y * job->pitch + (size_t)x * job->channel_count;
        decode_row(fast, &strip, job->y + y, outputs);
        for (uint32_t lane = 0; lane < count; lane++, texel += job->channel_count)
            for (uint32_t c = 0; c < job->channel_count; c++)
                texel[c] = outputs[job->first_channel + c][lane];
    }
}

static void decode_with(const struct slc_neural_job *job, const struct slc_neural_fast *fast)
{
    for (uint32_t x = 0; x < job->width; x += SLC_STRIP_LANES)
        decode_strip(job, fast, x,
                     job->width - x < SLC_STRIP_LANES ? job->width - x : SLC_STRIP_LANES);
}

static void decode_once(const struct slc_neural_job *job)
{
    struct slc_neural_fast fast;
    slc_neural_fast_init(&fast, job->shape, job->kind, job->weights);
    decode_with(job, &fast);
}

void slc_neural_decode_strips(const struct slc_neural_job *job)
{
    if (job->fast)
        decode_with(job, job->fast);
    else
        decode_once(job);
}
