#include "neural/slices.h"
#include "neural/strip_lanes.h"

#include <string.h>

void slc_strip_init(struct slc_neural_strip *strip, const struct slc_neural_mip_view *view,
                    uint32_t x, uint32_t count)
{
    strip->view = view;
    for (uint32_t lane = 0; lane < SLC_STRIP_LANES; lane++) {
        uint32_t column = x + (lane < count ? lane : count - 1);
        float waves[6];
        strip->x[lane] = column;
        for (uint32_t g = 0; g < 2; g++) {
            uint32_t corners[2], fraction;
            slc_neural_find_axis(view, g, 0, column, corners, &fraction);
            strip->columns[g][0][lane] = corners[0];
            strip->columns[g][1][lane] = corners[1];
            strip->fractions[g][lane] = (256 - fraction) | fraction << 16;
        }
        slc_neural_axis_waves(view, column, waves);
        for (int k = 0; k < 6; k++) {
            strip->waves[k][lane] = waves[k];
            strip->wave_codes[k][lane] = (uint32_t)slc_neural_wave_code(3, waves[k]);
        }
    }
}

/* Loads, per lane, four 4-bit codes of each of two adjacent texels. */
static slc_words load_codes(const struct slc_neural_strip *strip, uint32_t g, const uint8_t *row,
                            uint32_t size)
{
    uint32_t words[SLC_STRIP_LANES];
    slc_words codes;
    for (uint32_t lane = 0; lane < SLC_STRIP_LANES; lane++) {
        const uint8_t *left = row + (size_t)strip->columns[g][0][lane] * size;
        const uint8_t *right = row + (size_t)strip->columns[g][1][lane] * size;
        words[lane] = (uint32_t)left[0] | (uint32_t)left[1] << 8 | (uint32_t)right[0] << 16 |
                      (uint32_t)right[1] << 24;
    }
    memcpy(&codes, words, sizeof codes);
    return codes;
}

/* Computes 65536 times the mean of each feature's codes. Schema 3. */
static void sum_features(const struct slc_neural_strip *strip, uint32_t g, uint32_t y,
                         slc_words sums[16])
{
    const struct slc_neural_mip_view *view = strip->view;
    const uint32_t features = view->constants->highFeatures, size = features / 2;
    const size_t pitch = (size_t)(view->slices[g].sliceSize & 0xFFFF) * size;
    const slc_words one_code = (slc_words){0} + 0x000F000Fu;
    uint32_t rows[2], fraction;
    slc_neural_find_axis(view, g, 1, y, rows, &fraction);
    const uint8_t *top = view->codes[g] + rows[0] * pitch;
    const uint8_t *bottom = view->codes[g] + rows[1] * pitch;
    const slc_words fractions = (slc_words){0} + ((256 - fraction) | fraction << 16);
    for (uint32_t f = 0; f < features; f += 4) {
        slc_words above = load_codes(strip, g, top + f / 2, size);
        slc_words below = load_codes(strip, g, bottom + f / 2, size);
        for (uint32_t k = 0; k < 4; k++) { /* a mean of two codes has 12 bits */
            slc_words a = multiply_pairs(above >> 4 * k & one_code, strip->fractions[g]);
            slc_words b = multiply_pairs(below >> 4 * k & one_code, strip->fractions[g]);
            sums[f + k] = multiply_pairs(a | b << 16, fractions);
        }
    }
}

static slc_words pair_of(slc_words even, slc_words odd)
{
    return (even & 0xFFFF) | odd << 16;
}

static slc_words code_of_sum(slc_words sum)
{
    return (17 * sum >> 16) - 128;
}

static void int8_inputs_3(const struct slc_neural_strip *strip, uint32_t y, slc_words *pairs)
{
    const struct slc_neural_mip_view *view = strip->view;
    const uint32_t lod = (uint32_t)(int8_t)view->constants->mips[view->mip].lodCode;
    slc_words sums[16];
    float waves[6];
    for (uint32_t g = 0; g < 2; g++) {
        sum_features(strip, g, y, sums);
        for (uint32_t f = 0; f < view->constants->highFeatures; f += 2)
            pairs[8 * g + f / 2] = pair_of(code_of_sum(sums[f]), code_of_sum(sums[f + 1]));
    }
    slc_neural_axis_waves(view, y, waves);
    for (uint32_t k = 0; k < 6; k++) {
        uint32_t of_y = (uint32_t)slc_neural_wave_code(3, waves[k]);
        pairs[16 + k] = pair_of(strip->wave_codes[k], (slc_words){0} + of_y);
    }
    pairs[22] = (slc_words){0} + ((lod & 0xFFFF) | lod << 16);
}

/* Computes inputs of schema 1 texel by texel, because the four corners are separate inputs. */
static void int8_inputs_1(const struct slc_neural_strip *strip, uint32_t y, slc_words *pairs)
{
    for (uint32_t lane = 0; lane < SLC_STRIP_LANES; lane++) {
        int8_t inputs[SLC_NEURAL_MAX_INPUTS];
        slc_neural_int8_inputs(strip->view, strip->x[lane], y, inputs);
        for (uint32_t i = 0; i < strip->view->constants->inputCount; i++)
            pairs[i / 2][lane] |= (uint32_t)(uint16_t)inputs[i] << 16 * (i % 2);
    }
}

void slc_strip_int8_inputs(const struct slc_neural_strip *strip, uint32_t y, slc_words *pairs)
{
    memset(pairs, 0, strip->view->constants->inputCount / 2 * sizeof *pairs);
    (strip->view->constants->schema == 1 ? int8_inputs_1 : int8_inputs_3)(strip, y, pairs);
}

static void fp8_inputs_3(const struct slc_neural_strip *strip, uint32_t y, slc_floats *values)
{
    const struct slc_neural_mip_view *view = strip->view;
    slc_words sums[16];
    float waves[6];
    for (uint32_t g = 0; g < 2; g++) {
        sum_features(strip, g, y, sums);
        for (uint32_t f = 0; f < view->constants->highFeatures; f++)
            values[16 * g + f] =
                __builtin_convertvector((slc_ints)sums[f], slc_floats) * (2 / (15.0f * 65536.0f)) -
                1;
    }
    slc_neural_axis_waves(view, y, waves);
    for (uint32_t k = 0; k < 6; k++) {
        memcpy(&values[32 + 2 * k], strip->waves[k], sizeof *values);
        values[33 + 2 * k] = (slc_floats){0} + waves[k];
    }
    values[44] = values[45] = (slc_floats){0} + view->constants->mips[view->mip].positionLod;
}

static void fp8_inputs_1(const struct slc_neural_strip *strip, uint32_t y, slc_floats *values)
{
    for (uint32_t lane = 0; lane < SLC_STRIP_LANES; lane++) {
        float inputs[SLC_NEURAL_MAX_INPUTS];
        slc_neural_fp8_inputs(strip->view, strip->x[lane], y, inputs);
        for (uint32_t i = 0; i < strip->view->constants->inputCount; i++)
            values[i][lane] = inputs[i];
    }
}

void slc_strip_fp8_inputs(const struct slc_neural_strip *strip, uint32_t y, slc_floats *values)
{
    const uint32_t count = strip->view->constants->inputCount;
    memset(values, 0, count * sizeof *values);
    (strip->view->constants->schema == 1 ? fp8_inputs_1 : fp8_inputs_3)(strip, y, values);
    for (uint32_t i = 0; i < count; i++)
        values[i] = round_to_e4m3(round_to_half(values[i]));
}
