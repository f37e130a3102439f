/* Positions of texels in pages, and the sample count of filters. No C twins. */
#include "extremes/numerics.h"

#include <sluice/shared/texture_table.h>

#include <math.h>

static void put(uint32_t *words, uint32_t i, float value)
{
    words[i] = extremes_bits_of(value);
}

/* Folds a coordinate onto pages: next to a border, up to a texel plus the size outside. */
static long double exact_page_fold(float coordinate, uint32_t mode, uint32_t size)
{
    long double reach = 1 + 1.0L / size, c = coordinate;
    if (mode != SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER)
        return numerics_exact_fold(coordinate, mode);
    return c < -reach ? -reach : c > 1 + reach ? 1 + reach : c;
}

static void make_fold(uint64_t i, uint32_t *a)
{
    put(a, 0, numerics_make_coordinate(i));
    a[1] = extremes_random(i + 1) % 5;
    a[2] = numerics_make_size(i + 2);
}

/* 0: sluiceFoldOntoPages, 1: sluiceFoldCoordinate, 2: sluiceNearCoordinate. */
static void check_fold(const uint32_t *a, const uint32_t *r, bool device, struct extremes_row *rows)
{
    (void)device;
    if (!numerics_are_finite(a, 1))
        return;
    float c = numerics_real(a, 0);
    bool periodic =
        a[1] == SLUICE_ADDRESS_MODE_REPEAT || a[1] == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT;
    const long double wanted[2] = {exact_page_fold(c, a[1], a[2]), numerics_exact_fold(c, a[1])};
    for (uint32_t i = 0; i < 2; i++) {
        long double error = fabsl(numerics_real(r, i) - wanted[i]);
        if (a[1] == SLUICE_ADDRESS_MODE_REPEAT) /* 0 and 1 are the same position */
            error = fminl(error, fabsl(1 - error));
        extremes_add(&rows[i], (double)error, "%.9g, mode %u", (double)c, a[1]);
    }
    long double near = numerics_real(r, 2), moved = fabsl(near - (long double)c);
    if (periodic) /* moved by whole periods into 0 to 2 */
        moved = near >= 0 && near <= 2 ? fabsl(remainderl(near - (long double)c, 2))
                                       : moved > 0x1p-126L;
    extremes_add(&rows[2], (double)moved, "%.9g, mode %u", (double)c, a[1]);
}

/* Vulkan's wrapping of texel coordinates. -1: border. */
static int64_t wrapped(int64_t i, uint32_t mode, int64_t n)
{
    switch (mode) {
    case SLUICE_ADDRESS_MODE_REPEAT: return (i % n + n) % n;
    case SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER: return i < 0 || i >= n ? -1 : i;
    default: return i < 0 ? 0 : i >= n ? n - 1 : i; /* already folded */
    }
}

/*
 * Words 0, 1: low, high; 2: weight; 3: the nearest. Returns the error of low + weight against the
 * exact position, for the nearest texels with these numbers.
 */
static long double axis_error(long double place, uint32_t mode, int64_t n, const uint32_t *r)
{
    long double error = INFINITY, weight = numerics_real(r, 2);
    int64_t base = (int64_t)floorl(place);
    for (int64_t k = base - 2; k <= base + 2; k++) {
        if (wrapped(k, mode, n) != (int32_t)r[0] || wrapped(k + 1, mode, n) != (int32_t)r[1])
            continue;
        long double here = fabsl((long double)k + weight - place);
        if (mode == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER && (int32_t)r[0] < 0 && (int32_t)r[1] < 0)
            here = 0; /* both are border */
        error = fminl(error, here);
    }
    return error;
}

static long double nearest_error(long double place, uint32_t mode, int64_t n, int32_t got)
{
    long double error = INFINITY;
    int64_t base = (int64_t)floorl(place);
    for (int64_t k = base - 2; k <= base + 2; k++)
        if (wrapped(k, mode, n) == got)
            error = fminl(error, place < (long double)k       ? (long double)k - place
                                 : place > (long double)k + 1 ? place - (long double)k - 1
                                                              : 0);
    return error;
}

static void check_page_axis(const uint32_t *a, const uint32_t *r, bool device,
                            struct extremes_row *rows)
{
    (void)device;
    int64_t n = a[2];
    const int64_t texels[3] = {(int32_t)r[0], (int32_t)r[1], (int32_t)r[3]};
    for (int i = 0; i < 3; i++)
        if (numerics_are_finite(a, 1) && (texels[i] < -1 || texels[i] >= n))
            extremes_add(&rows[0], INFINITY, "a texel outside");
    if (!numerics_are_finite(a, 1))
        return;
    long double c = exact_page_fold(numerics_real(a, 0), a[1], a[2]), scale = n / 16384.0L;
    long double errors[2] = {INFINITY, INFINITY};
    int turns = a[1] == SLUICE_ADDRESS_MODE_REPEAT; /* 0 and 1 are the same position */
    for (int turn = -turns; turn <= turns; turn++) {
        long double place = (c + turn) * n;
        errors[0] = fminl(errors[0], axis_error(place - 0.5L, a[1], n, r));
        errors[1] = fminl(errors[1], nearest_error(place, a[1], n, (int32_t)r[3]));
    }
    for (int i = 0; i < 2; i++)
        extremes_add(&rows[i ? 2 : n > 1024], (double)(errors[i] / fmaxl(1, scale)),
                     "%.9g of %u texels, mode %u", (double)numerics_real(a, 0), a[2], a[1]);
}

/* Arguments 0 to 3: dx, dy in uv; 4: width and height; 5: levels; 6: lod; 7: most taps. */
static void make_taps(uint64_t i, uint32_t *a)
{
    uint32_t size = numerics_make_size(i), levels = 1;
    numerics_make_derivatives(i, a);
    for (uint32_t k = 0; k < 4; k++)
        put(a, k, numerics_real(a, k) / (float)size);
    while (size >> levels)
        levels++;
    a[4] = size;
    a[5] = levels;
    float part = (float)extremes_random(i + 3) / 4294967296.0f;
    float lod = i % 5 ? part * (float)(levels - 1)
                      : nextafterf((float)(extremes_random(i + 4) % levels), i % 2 ? 99 : -99);
    put(a, 6, fminf(fmaxf(lod, 0), (float)(levels - 1)));
    put(a, 7, i % 3 ? (float)(1 << extremes_random(i + 6) % 5) : 1 + part * 15);
}

static bool ratio_gives(long double ratio, float most, uint32_t count)
{
    long double exact = fminl(fmaxl(ceill(ratio - 0.01L), 1), most);
    return count == (uint32_t)exact;
}

/* Relative error of a ratio against ratios that give this sample count. */
static long double count_error(long double ratio, float most, uint32_t count)
{
    if (!(most > 1))
        return count == 1 ? 0 : INFINITY;
    if (ratio_gives(ratio, most, count))
        return 0;
    for (long double error = 1e-9L; error < 1; error *= 1.25L)
        if (ratio_gives(ratio * (1 - error), most, count) ||
            ratio_gives(ratio * (1 + error), most, count))
            return error;
    return INFINITY;
}

static void check_taps(const uint32_t *a, const uint32_t *r, bool device, struct extremes_row *rows)
{
    (void)device;
    long double lod = numerics_real(a, 6), fine = floorl(lod), last = a[5] - 1.0L;
    bool right = r[0] == fine && r[1] == fminl(fine + 1, last);
    extremes_add(&rows[0],
                 right ? (double)fabsl(lod - fine - numerics_real(r, 2)) : (double)INFINITY,
                 "LOD %.9g of %u", (double)lod, a[5]);
    for (uint32_t i = 0; i < 4; i++)
        if (!isfinite(numerics_real(a, i)))
            return;
    long double size = a[4];
    long double x = hypotl(numerics_real(a, 0) * size, numerics_real(a, 1) * size);
    long double y = hypotl(numerics_real(a, 2) * size, numerics_real(a, 3) * size);
    long double ratio = fmaxl(x, y) / exp2l(lod);
    extremes_add(&rows[1], (double)count_error(ratio, numerics_real(a, 7), r[3]),
                 "%Lg pixels long, up to %g, %u", ratio, (double)numerics_real(a, 7), r[3]);
}

static long double spline(long double x)
{
    x = fabsl(x);
    if (x >= 2)
        return 0;
    return x >= 1 ? (2 - x) * (2 - x) * (2 - x) / 6 : (3 * x * x * x - 6 * x * x + 4) / 6;
}

/* Weight of texel `k` in two linear samples (position and weight, twice). */
static long double implied_weight(const uint32_t *r, long double n, long double k)
{
    long double sum = 0;
    for (uint32_t half = 0; half < 2; half++) {
        long double at = numerics_real(r, 2 * half) * n - 0.5L;
        sum += fmaxl(1 - fabsl(at - k), 0) * numerics_real(r, 2 * half + 1);
    }
    return sum;
}

static void make_spline(uint64_t i, uint32_t *a)
{
    static const uint32_t sizes[] = {1, 2, 5, 64, 1023, 4096, 16384};
    float part = (float)extremes_random(i) / 4294967296.0f;
    a[1] = sizes[extremes_random(i + 1) % 7];
    put(a, 0, i % 2 ? part * 2 - 0.5f : ((float)(i / 2 % 9) - 2.5f + part * 1e-4f) / (float)a[1]);
}

static void check_spline(const uint32_t *a, const uint32_t *r, bool device,
                         struct extremes_row *rows)
{
    (void)device;
    long double n = a[1], place = numerics_real(a, 0) * n - 0.5L;
    for (long double k = floorl(place) - 3; k <= floorl(place) + 4; k++)
        extremes_add(rows, (double)fabsl(implied_weight(r, n, k) - spline(k - place)),
                     "%.9g of %u texels", (double)numerics_real(a, 0), a[1]);
}

static void make_demand_lod(uint64_t i, uint32_t *a)
{
    numerics_make_derivatives(i, a);
    put(a, 4, i % 3 ? (float)(1 << extremes_random(i) % 7) : 1);
}

/* Promised for sums that are normal numbers below 3e38. */
static void check_demand_lod(const uint32_t *a, const uint32_t *r, bool device,
                             struct extremes_row *rows)
{
    const float dx[2] = {numerics_real(a, 0), numerics_real(a, 1)};
    const float dy[2] = {numerics_real(a, 2), numerics_real(a, 3)};
    long double sum = 0;
    for (uint32_t i = 0; i < 4; i++)
        sum += fabsl(numerics_real(a, i));
    if (!(sum <= 2.99e38L && sum >= (device ? 0x1p-100L : 0x1p-126L)))
        return; /* parts of a smaller one may be denormal, and flushed to 0 */
    struct numerics_lods lods = numerics_exact_lods(dx, dy, numerics_real(a, 4));
    extremes_add(rows, (double)fabsl(numerics_real(r, 0) - lods.finest),
                 "dx %g %g dy %g %g, %g to 1", (double)dx[0], (double)dx[1], (double)dy[0],
                 (double)dy[1], (double)numerics_real(a, 4));
}

/* Arguments 0 to 3: derivatives in uv; 4: size; 5: width in texels. */
static void make_widen(uint64_t i, uint32_t *a)
{
    uint32_t size = numerics_make_size(i);
    numerics_make_derivatives(i % 4 ? i : i + 1, a);
    for (uint32_t k = 0; k < 4; k++)
        put(a, k, numerics_real(a, k) / (float)size);
    put(a, 4, (float)size);
    put(a, 5, exp2f((float)extremes_random(i + 1) / 4294967296.0f * 30 - 16));
}

/* A narrower footprint would request finer levels than resident. The longer derivative must not
 * change. */
static void check_widen(const uint32_t *a, const uint32_t *r, bool device,
                        struct extremes_row *rows)
{
    (void)device;
    float size = numerics_real(a, 4), width = numerics_real(a, 5), d[2][2], was[2][2];
    for (uint32_t i = 0; i < 4; i++) {
        d[i / 2][i % 2] = numerics_real(r, i) * size;
        was[i / 2][i % 2] = numerics_real(a, i) * size;
    }
    struct numerics_lods now = numerics_exact_lods(d[0], d[1], 1);
    struct numerics_lods before = numerics_exact_lods(was[0], was[1], 1);
    extremes_add(&rows[0], (double)fabsl(now.minor / width - 1), "%g texels of %g", (double)width,
                 (double)size);
    extremes_add(&rows[1], (double)fabsl(now.longer / fmaxl(before.longer, width) - 1),
                 "%Lg, %g texels of %g", before.longer, (double)width, (double)size);
}

#define AT(i) [(i)-NUMERICS_LOD_COUNT - NUMERICS_REGION_COUNT]
#define NO_C 0 /* no twin, no bound */

const struct numerics_function numerics_pages[NUMERICS_PAGE_COUNT] = {
    AT(NUMERICS_FOLD) = {"fold_coordinate",
                         {{"pages", "images", NO_C, 2.4e-7},
                          {"quick", "images", NO_C, 2.4e-7},
                          {"near", "images", NO_C, 2.4e-7}},
                         200000,
                         10000000,
                         make_fold,
                         NULL,
                         check_fold},
    AT(NUMERICS_PAGE_AXIS) = {"page_axis",
                              {{"small", "texels", NO_C, 0.0025},
                               {"large", "texels of 16384", NO_C, 0.006},
                               {"nearest", "texels of 16384", NO_C, 0.004}},
                              200000,
                              10000000,
                              make_fold,
                              NULL,
                              check_page_axis},
    AT(NUMERICS_TAPS) = {"place_taps",
                         {{"fraction", "levels", NO_C, 0.00196}, {"count", "relative", NO_C, 1e-5}},
                         200000,
                         10000000,
                         make_taps,
                         NULL,
                         check_taps},
    AT(NUMERICS_SPLINE) = {"filter_axis",
                           {{"weight", "weight", NO_C, 2e-3}},
                           100000,
                           10000000,
                           make_spline,
                           NULL,
                           check_spline},
    AT(NUMERICS_DEMAND_LOD) = {"demand_compute_lod",
                               {{"lod", "levels", NO_C, 1e-4}},
                               200000,
                               10000000,
                               make_demand_lod,
                               NULL,
                               check_demand_lod},
    AT(NUMERICS_WIDEN) = {"widen",
                          {{"width", "relative", NO_C, 1e-5}, {"length", "relative", NO_C, 1e-5}},
                          200000,
                          10000000,
                          make_widen,
                          NULL,
                          check_widen},
};
