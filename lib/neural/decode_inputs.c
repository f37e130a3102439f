#include "neural/decoder.h"
#include "neural/slices.h"

#include <string.h>

static uint32_t low(uint32_t pair)
{
    return pair & 0xFFFF;
}

static uint32_t high(uint32_t pair)
{
    return pair >> 16;
}

/* Converts a grid texel to a texel of the slice, clamped to the slice. */
static uint32_t clamp_corner(int32_t corner, uint32_t grid, uint32_t origin, uint32_t size)
{
    int32_t last = (int32_t)grid - 1;
    int32_t at = (corner < 0 ? 0 : corner > last ? last : corner) - (int32_t)origin;
    return at < 0 ? 0 : at < (int32_t)size ? (uint32_t)at : size - 1;
}

static uint32_t wrap_corner(int32_t corner, uint32_t grid, uint32_t origin, uint32_t size)
{
    int32_t at = corner < 0 ? corner + (int32_t)grid : corner;
    at = (at >= (int32_t)grid ? at - (int32_t)grid : at) - (int32_t)origin;
    at = at < 0 ? at + (int32_t)grid : at;
    return at < (int32_t)size ? (uint32_t)at : size - 1;
}

void slc_neural_find_axis(const struct slc_neural_mip_view *view, uint32_t g, uint32_t axis,
                          uint32_t texel, uint32_t corners[2], uint32_t *fraction)
{
    const SluiceNeuralSlice *slice = &view->slices[g];
    uint32_t (*const part)(uint32_t) = axis ? high : low;
    uint32_t grid = part(slice->gridSize);
    int32_t place = slc_neural_place(texel, grid, axis ? view->height : view->width);
    int32_t corner = slc_neural_corner(place);
    uint32_t (*const fit)(int32_t, uint32_t, uint32_t, uint32_t) =
        view->constants->schema == 1 ? clamp_corner : wrap_corner;
    for (int32_t i = 0; i < 2; i++)
        corners[i] = fit(corner + i, grid, part(slice->origin), part(slice->sliceSize));
    *fraction = (uint32_t)(place + 256) & 255;
}

void slc_neural_find_corners(const struct slc_neural_mip_view *view, uint32_t g, uint32_t x,
                             uint32_t y, struct slc_neural_corners *c)
{
    uint32_t xs[2], ys[2], fx, fy, width = low(view->slices[g].sliceSize);
    slc_neural_find_axis(view, g, 0, x, xs, &fx);
    slc_neural_find_axis(view, g, 1, y, ys, &fy);
    for (uint32_t i = 0; i < 4; i++) {
        c->texels[i] = ys[i / 2] * width + xs[i % 2];
        c->weights[i] = (i % 2 ? fx : 256 - fx) * (i / 2 ? fy : 256 - fy);
    }
}

/* Computes three position waves of four values each, -1 to 1. */
static void position_waves(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                           float waves[12])
{
    float of_x[6], of_y[6];
    slc_neural_axis_waves(view, x, of_x);
    slc_neural_axis_waves(view, y, of_y);
    for (int k = 0; k < 6; k++) {
        waves[2 * k] = of_x[k];
        waves[2 * k + 1] = of_y[k];
    }
}

/* Writes the inputs for position and level, from input `at` on. */
static void int8_tail(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                      int8_t *inputs)
{
    float waves[12];
    position_waves(view, x, y, waves);
    for (int i = 0; i < 12; i++)
        inputs[i] = (int8_t)slc_neural_wave_code(view->constants->schema, waves[i]);
    inputs[12] = inputs[13] = (int8_t)view->constants->mips[view->mip].lodCode;
}

static void fp8_tail(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y, float *inputs)
{
    position_waves(view, x, y, inputs);
    inputs[12] = inputs[13] = view->constants->mips[view->mip].positionLod;
}

/* Returns a code of schema 1 in units of 1 / 127.5. */
static int32_t code_value(uint32_t code, uint32_t bits)
{
    int32_t c = (int32_t)code;
    return bits == 1 ? 85 * c : bits == 2 ? 51 * c - 51 : bits == 4 ? 15 * c - 105 : c - 126;
}

/* Returns floor(a / 256). */
static int32_t shift_down(int32_t a)
{
    return (a - (a & 255)) / 256;
}

static void int8_inputs_1(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                          int8_t *inputs)
{
    const SluiceNeuralConstants *k = view->constants;
    uint32_t features = k->networkFeatures;
    struct slc_neural_corners c;
    slc_neural_find_corners(view, 0, x, y, &c);
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t f = 0; f < k->highFeatures; f++) {
            uint32_t code =
                slc_neural_code(view->codes[0], k->highFeatures, k->highBits, c.texels[i], f);
            int32_t value = code_value(code, k->highBits) * (int32_t)(c.weights[i] >> 8);
            inputs[i * features + f] = (int8_t)shift_down(value);
        }
    slc_neural_find_corners(view, 1, x, y, &c);
    for (uint32_t f = 0; f < k->lowFeatures; f++) {
        int32_t sum = 0;
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t code =
                slc_neural_code(view->codes[1], k->lowFeatures, k->lowBits, c.texels[i], f);
            sum += code_value(code, k->lowBits) * (int32_t)(c.weights[i] >> 8);
        }
        inputs[4 * features + f] = (int8_t)shift_down(sum);
    }
    int8_tail(view, x, y, inputs + 4 * features + 16);
}

/* Returns 65536 times the mean of a feature's codes. */
static uint32_t sum_codes(const struct slc_neural_mip_view *view, uint32_t g,
                          const struct slc_neural_corners *c, uint32_t feature)
{
    uint32_t features = view->constants->highFeatures, sum = 0;
    for (uint32_t i = 0; i < 4; i++)
        sum += c->weights[i] * slc_neural_code(view->codes[g], features, 4, c->texels[i], feature);
    return sum;
}

static void int8_inputs_3(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                          int8_t *inputs)
{
    struct slc_neural_corners c;
    for (uint32_t g = 0; g < 2; g++) {
        slc_neural_find_corners(view, g, x, y, &c);
        for (uint32_t f = 0; f < view->constants->highFeatures; f++)
            inputs[16 * g + f] = (int8_t)((int32_t)(17 * sum_codes(view, g, &c, f) >> 16) - 128);
    }
    int8_tail(view, x, y, inputs + 32);
}

void slc_neural_int8_inputs(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                            int8_t *inputs)
{
    memset(inputs, 0, view->constants->inputCount);
    (view->constants->schema == 1 ? int8_inputs_1 : int8_inputs_3)(view, x, y, inputs);
}

static void fp8_inputs_1(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                         float *inputs)
{
    const SluiceNeuralConstants *k = view->constants;
    uint32_t features = k->networkFeatures;
    struct slc_neural_corners c;
    const float unit = 1 / (127.5f * 65536.0f);
    slc_neural_find_corners(view, 0, x, y, &c);
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t f = 0; f < k->highFeatures; f++) {
            uint32_t code =
                slc_neural_code(view->codes[0], k->highFeatures, k->highBits, c.texels[i], f);
            inputs[i * features + f] =
                (float)(code_value(code, k->highBits) * (int32_t)c.weights[i]) * unit;
        }
    slc_neural_find_corners(view, 1, x, y, &c);
    for (uint32_t f = 0; f < k->lowFeatures; f++) {
        int32_t sum = 0;
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t code =
                slc_neural_code(view->codes[1], k->lowFeatures, k->lowBits, c.texels[i], f);
            sum += code_value(code, k->lowBits) * (int32_t)c.weights[i];
        }
        inputs[4 * features + f] = (float)sum * unit;
    }
    fp8_tail(view, x, y, inputs + 4 * features + 16);
}

static void fp8_inputs_3(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                         float *inputs)
{
    struct slc_neural_corners c;
    for (uint32_t g = 0; g < 2; g++) {
        slc_neural_find_corners(view, g, x, y, &c);
        for (uint32_t f = 0; f < view->constants->highFeatures; f++)
            inputs[16 * g + f] = (float)sum_codes(view, g, &c, f) * (2 / (15.0f * 65536.0f)) - 1;
    }
    fp8_tail(view, x, y, inputs + 32);
}

void slc_neural_fp8_inputs(const struct slc_neural_mip_view *view, uint32_t x, uint32_t y,
                           float *inputs)
{
    for (uint32_t i = 0; i < view->constants->inputCount; i++)
        inputs[i] = 0;
    (view->constants->schema == 1 ? fp8_inputs_1 : fp8_inputs_3)(view, x, y, inputs);
}
