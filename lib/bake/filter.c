#include "bake/filter.h"

#include "base/checked.h"

#include <assert.h>
#include <math.h>

#define KAISER_RADIUS 3.0
#define KAISER_ALPHA 4.0
#define PI 3.14159265358979323846

struct slc_axis slc_axis_make(uint32_t size, SluiceBakeFilter filter, SluiceBakeWrap wrap)
{
    return (struct slc_axis){size, slc_mip_size(size, 1), filter, wrap};
}

static double axis_scale(const struct slc_axis *axis)
{
    return (double)axis->size / axis->below;
}

/* Modified Bessel function of the first kind and order 0, by its power series. */
static double bessel(double x)
{
    double sum = 1.0, term = 1.0;
    for (int k = 1; term > 1e-16 * sum; k++) {
        term *= x * x / (4.0 * k * k);
        sum += term;
    }
    return sum;
}

/* Sinc with a Kaiser window; `x` in texels of the level below. */
static double kaiser(double x)
{
    double t = x / KAISER_RADIUS;
    if (t * t >= 1.0)
        return 0.0;
    double sinc = x * x < 1e-12 ? 1.0 : sin(PI * x) / (PI * x);
    return sinc * bessel(KAISER_ALPHA * sqrt(1.0 - t * t)) / bessel(KAISER_ALPHA);
}

/* Integrates the filter over a texel, as a sum of 16 samples. */
static double kaiser_over_texel(const struct slc_axis *axis, double center, int32_t texel)
{
    double sum = 0.0;
    for (int s = 0; s < 16; s++)
        sum += kaiser((texel + (s + 0.5) / 16.0 - center) / axis_scale(axis));
    return sum;
}

static void kaiser_taps(const struct slc_axis *axis, uint32_t i, struct slc_taps *taps)
{
    double center = (i + 0.5) * axis_scale(axis), sum = 0.0, weights[SLC_MAX_TAPS];
    taps->count = slc_axis_max_taps(axis);
    for (uint32_t t = 0; t < taps->count; t++)
        sum += weights[t] = kaiser_over_texel(axis, center, taps->first + (int32_t)t);
    for (uint32_t t = 0; t < taps->count; t++)
        taps->weights[t] = (float)(weights[t] / sum);
}

/* Exact shares of 2n + 1 texels on n: each covers 2 + 1/n of them, from i/n after texel 2i on. */
static void box_taps(const struct slc_axis *axis, uint32_t i, struct slc_taps *taps)
{
    taps->count = slc_axis_max_taps(axis);
    if (taps->count == 2) {
        taps->weights[0] = taps->weights[1] = 0.5f;
        return;
    }
    double n = axis->below, total = axis->size;
    taps->weights[0] = (float)((n - i) / total);
    taps->weights[1] = (float)(n / total);
    taps->weights[2] = (float)((i + 1) / total);
}

int32_t slc_axis_first(const struct slc_axis *axis, uint32_t i)
{
    if (axis->size == 1)
        return 0;
    if (axis->filter == SLUICE_BAKE_FILTER_BOX)
        return (int32_t)(2 * i);
    return (int32_t)floor((i + 0.5 - KAISER_RADIUS) * axis_scale(axis));
}

uint32_t slc_axis_max_taps(const struct slc_axis *axis)
{
    if (axis->size == 1)
        return 1;
    if (axis->filter == SLUICE_BAKE_FILTER_BOX)
        return axis->size % 2 ? 3 : 2;
    return (uint32_t)ceil(2.0 * KAISER_RADIUS * axis_scale(axis)) + 1;
}

void slc_axis_taps(const struct slc_axis *axis, uint32_t i, struct slc_taps *taps)
{
    assert(i < axis->below);
    taps->first = slc_axis_first(axis, i);
    if (axis->size == 1) {
        taps->count = 1;
        taps->weights[0] = 1.0f;
    } else if (axis->filter == SLUICE_BAKE_FILTER_BOX) {
        box_taps(axis, i, taps);
    } else {
        kaiser_taps(axis, i, taps);
    }
}

uint32_t slc_wrap_index(SluiceBakeWrap wrap, int32_t index, uint32_t size)
{
    int64_t n = size, period = wrap == SLUICE_BAKE_WRAP_MIRROR ? 2 * n : n;
    if (index >= 0 && index < n)
        return (uint32_t)index;
    if (wrap == SLUICE_BAKE_WRAP_CLAMP)
        return index < 0 ? 0 : size - 1;
    int64_t inside = (index % period + period) % period;
    return (uint32_t)(inside < n ? inside : period - 1 - inside);
}
