#include "bake/columns.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Four floats at once, at any address that a float may have. */
typedef float texel __attribute__((vector_size(16), aligned(4), may_alias));

static size_t weight_count(const struct slc_axis *axis)
{
    size_t distinct = axis->size % 2 == 0 || axis->size == 1 ? 1 : axis->below;
    return distinct * slc_axis_max_taps(axis);
}

static size_t padded_count(const struct slc_axis *axis)
{
    if (axis->filter == SLUICE_BAKE_FILTER_BOX || axis->size == 1)
        return 0;
    return 4 * ((size_t)axis->size + 2 * SLC_MAX_REACH);
}

uint64_t slc_columns_memory(const struct slc_axis *axis)
{
    return (weight_count(axis) + padded_count(axis)) * sizeof(float);
}

SluiceResult slc_columns_init(struct slc_columns *columns, const SluiceAllocationCallbacks *cb,
                              const struct slc_axis *axis)
{
    *columns = (struct slc_columns){.axis = *axis, .tap_count = slc_axis_max_taps(axis)};
    columns->distinct = (uint32_t)(weight_count(axis) / columns->tap_count);
    columns->weights = slc_alloc(cb, weight_count(axis), sizeof(float));
    if (!columns->weights)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (padded_count(axis)) {
        columns->padded = slc_alloc(cb, padded_count(axis), sizeof(float));
        if (!columns->padded)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    for (uint32_t i = 0; i < columns->distinct; i++) {
        struct slc_taps taps;
        slc_axis_taps(axis, i, &taps);
        memcpy(columns->weights + (size_t)i * columns->tap_count, taps.weights,
               columns->tap_count * sizeof(float));
    }
    return SLUICE_SUCCESS;
}

void slc_columns_finish(struct slc_columns *columns, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, columns->weights, weight_count(&columns->axis), sizeof(float));
    slc_free(cb, columns->padded, padded_count(&columns->axis), sizeof(float));
    columns->weights = columns->padded = NULL;
}

static void pad_row(struct slc_columns *columns, const float *row)
{
    uint32_t size = columns->axis.size;
    SluiceBakeWrap wrap = columns->axis.wrap;
    float *left = columns->padded, *right = left + 4 * ((size_t)size + SLC_MAX_REACH);
    memcpy(left + 4 * SLC_MAX_REACH, row, 4 * (size_t)size * sizeof(float));
    for (int32_t i = 0; i < SLC_MAX_REACH; i++) {
        memcpy(left + 4 * i, row + 4 * (size_t)slc_wrap_index(wrap, i - SLC_MAX_REACH, size),
               4 * sizeof(float));
        memcpy(right + 4 * i, row + 4 * (size_t)slc_wrap_index(wrap, (int32_t)size + i, size),
               4 * sizeof(float));
    }
}

static void halve(const texel *row, texel *below, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        below[i] = (row[2 * (size_t)i] + row[2 * (size_t)i + 1]) * 0.5f;
}

static void weigh(const struct slc_columns *columns, const texel *row, texel *below)
{
    size_t stride = columns->distinct > 1 ? columns->tap_count : 0;
    const float *weights = columns->weights;
    for (uint32_t i = 0; i < columns->axis.below; i++, weights += stride) {
        const texel *first = row + slc_axis_first(&columns->axis, i);
        texel sum = first[0] * weights[0];
        for (uint32_t t = 1; t < columns->tap_count; t++)
            sum += first[t] * weights[t];
        below[i] = sum;
    }
}

void slc_columns_apply(struct slc_columns *columns, const float *row, float *below)
{
    const struct slc_axis *axis = &columns->axis;
    if (axis->size == 1) {
        memcpy(below, row, 4 * sizeof(float));
    } else if (columns->padded) {
        pad_row(columns, row);
        weigh(columns, (const texel *)(columns->padded + 4 * SLC_MAX_REACH), (texel *)below);
    } else if (axis->size % 2 == 0) {
        halve((const texel *)row, (texel *)below, axis->below);
    } else {
        weigh(columns, (const texel *)row, (texel *)below);
    }
}

static float saturate(double value)
{
    return (float)fmin(fmax(value, -(double)FLT_MAX), (double)FLT_MAX);
}

void slc_columns_apply_wide(struct slc_columns *columns, const float *row, float *below)
{
    const struct slc_axis *axis = &columns->axis;
    size_t stride = columns->distinct > 1 ? columns->tap_count : 0;
    const float *weights = columns->weights;
    if (columns->padded) {
        pad_row(columns, row);
        row = columns->padded + 4 * SLC_MAX_REACH;
    }
    for (uint32_t i = 0; i < axis->below; i++, weights += stride)
        for (uint32_t c = 0; c < 4; c++) {
            const float *in = row + 4 * (ptrdiff_t)slc_axis_first(axis, i) + c;
            double sum = 0.0;
            for (uint32_t t = 0; t < columns->tap_count; t++)
                sum += (double)in[4 * (size_t)t] * (double)weights[t];
            below[4 * (size_t)i + c] = saturate(sum);
        }
}

bool slc_row_is_finite(const float *row, uint32_t count)
{
    const texel *in = (const texel *)row;
    texel sum = {0};
    for (uint32_t i = 0; i < count; i++)
        sum += in[i] * 0.0f; /* NaN for NaN and infinities */
    return sum[0] + sum[1] + sum[2] + sum[3] == 0.0f;
}

void slc_row_set(const float *row, float weight, float *sum, uint32_t count)
{
    const texel *in = (const texel *)row;
    texel *out = (texel *)sum;
    for (uint32_t i = 0; i < count; i++)
        out[i] = in[i] * weight;
}

void slc_row_add(const float *row, float weight, float *sum, uint32_t count)
{
    const texel *in = (const texel *)row;
    texel *out = (texel *)sum;
    for (uint32_t i = 0; i < count; i++)
        out[i] += in[i] * weight;
}
