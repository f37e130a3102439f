/* Levels of detail, and functions that use them. */
#include "extremes/numerics.h"

#include "vulkan/shader_twins.h"

#include <math.h>
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

static struct slc_twin_vec2 real2(const uint32_t *a, uint32_t i)
{
    return (struct slc_twin_vec2){numerics_real(a, i), numerics_real(a, i + 1)};
}

static void put(uint32_t *results, uint32_t i, float value)
{
    results[i] = extremes_bits_of(value);
}

/* Follows the promises of the shader headers, not their implementation. */
static long double clamped_anisotropy(float n)
{
    return n > 1 ? fminf(n, 16) : 1;
}

static long double clamped_lod(long double lod)
{
    return isnan(lod) || lod > 32 ? 32 : lod < -32 ? -32 : lod;
}

/* Lengths count from 2^-32 to 2^32, as floats with such squares. Then the bias is added. */
static long double biased(long double lod, long double bias)
{
    const long double low = log2l(5.4e-20f) / 2, high = log2l(1.8e19f) / 2;
    return (lod < low ? low : lod > high ? high : lod) + bias;
}

static bool has_nan(const uint32_t *a, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (isnan(numerics_real(a, i)))
            return true;
    return false;
}

static struct numerics_lods exact_lods(const uint32_t *a, float bias, float anisotropy)
{
    const float dx[2] = {numerics_real(a, 0), numerics_real(a, 1)};
    const float dy[2] = {numerics_real(a, 2), numerics_real(a, 3)};
    struct numerics_lods lods = {.finest = INFINITY, .coarsest = INFINITY, .isotropic = INFINITY};
    bool infinite = false;
    for (int i = 0; i < 2; i++)
        infinite |= isinf(dx[i]) || isinf(dy[i]);
    if (!infinite)
        lods = numerics_exact_lods(dx, dy, clamped_anisotropy(anisotropy));
    long double b = clamped_lod(bias);
    lods.finest = biased(lods.finest, b);
    lods.coarsest = biased(lods.coarsest, b);
    lods.isotropic = biased(lods.isotropic, b);
    return lods;
}

static void make_lods(uint64_t i, uint32_t *a)
{
    numerics_make_derivatives(i, a);
    put(a, 4, numerics_make_bias(i));
    put(a, 5, numerics_make_anisotropy(i / 2));
}

static void call_lods(const uint32_t *a, uint32_t *r)
{
    struct slc_twin_vec2 lods =
        slc_twin_compute_lods(real2(a, 0), real2(a, 2), numerics_real(a, 4), numerics_real(a, 5));
    put(r, 0, lods.x);
    put(r, 1, lods.y);
}

static void check_lods(const uint32_t *a, const uint32_t *r, bool device, struct extremes_row *rows)
{
    float got[2] = {numerics_real(r, 0), numerics_real(r, 1)};
    for (int i = 0; i < 2; i++)
        if (!(got[i] >= -32 && got[i] <= 32))
            extremes_add(&rows[i], INFINITY, "a level outside its range");
    if (has_nan(a, 4)) {
        if (!device && !(got[0] == 32 && got[1] == 32))
            extremes_add(&rows[0], INFINITY, "NaN");
        return;
    }
    if (device && has_nan(a + 4, 2))
        return;
    struct numerics_lods exact = exact_lods(a, numerics_real(a, 4), numerics_real(a, 5));
    const long double wanted[2] = {clamped_lod(exact.finest), clamped_lod(exact.coarsest + 0.125L)};
    for (int i = 0; i < 2; i++)
        extremes_add(&rows[i], (double)fabsl((long double)got[i] - wanted[i]),
                     "dx %g %g dy %g %g bias %g, %g to 1", (double)numerics_real(a, 0),
                     (double)numerics_real(a, 1), (double)numerics_real(a, 2),
                     (double)numerics_real(a, 3), (double)numerics_real(a, 4),
                     (double)numerics_real(a, 5));
}

/*
 * Checks the levels that a sample marks. `lost`: how many levels a mark is on the wrong side of the
 * promised margin. The margins of 1/8 and 3/16 exceed the measured 0.12 of samplers, which leaves
 * room. `more`: how many levels a mark is beyond the promise.
 */
static void check_levels(const struct numerics_lods *exact, float anisotropy, uint32_t count,
                         const uint32_t *levels, struct extremes_row *rows, const uint32_t *a)
{
    long double fine = exact->finest - (anisotropy > 1 ? 0.1875L : 0.125L);
    const long double coarse[2] = {exact->coarsest + 0.125L, exact->isotropic + 0.125L};
    uint32_t last = count - 1;
    long double lost = -1, more = -1;
    if (levels[0] > 0)
        lost = fmaxl(lost, levels[0] - fine);
    if (levels[0] < last)
        more = fmaxl(more, fine - (levels[0] + 1.0L));
    for (int i = 0; i < 2; i++) {
        if (levels[1 + i] < last)
            lost = fmaxl(lost, fmaxl(coarse[i], 0) - levels[1 + i]);
        if (levels[1 + i] > 1 && levels[1 + i] <= last)
            more = fmaxl(more, levels[1 + i] - 1.0L - coarse[i]);
        if (levels[1 + i] > last || levels[0] > last || (levels[1 + i] == 0 && last > 0))
            lost = INFINITY;
    }
    const long double both[2] = {lost, more};
    for (int i = 0; i < 2; i++)
        extremes_add(&rows[i], (double)both[i], "dx %g %g dy %g %g bias %g, %g to 1",
                     (double)numerics_real(a, 0), (double)numerics_real(a, 1),
                     (double)numerics_real(a, 2), (double)numerics_real(a, 3),
                     (double)numerics_real(a, 4), (double)anisotropy);
}

static void make_levels(uint64_t i, uint32_t *a)
{
    make_lods(i, a);
    a[6] = 1 + extremes_random(i + 7) % 16;
}

static void call_quick_levels(const uint32_t *a, uint32_t *r)
{
    struct slc_twin_squares s = slc_twin_square_lods(real2(a, 0), real2(a, 2), numerics_real(a, 5));
    struct slc_twin_levels levels =
        slc_twin_quick_levels(s, numerics_real(a, 4), numerics_real(a, 5), a[6]);
    put(r, 3, s.sum);
    memcpy(r, &levels, sizeof levels);
}

static void check_quick_levels(const uint32_t *a, const uint32_t *r, bool device,
                               struct extremes_row *rows)
{
    float bias = numerics_real(a, 4);
    if (!(numerics_real(r, 3) < SLC_TWIN_QUICK_SQUARES) || !(fabsf(bias) <= SLC_TWIN_QUICK_BIAS))
        return; /* unused then */
    if (has_nan(a, 4) || (device && has_nan(a + 5, 1)))
        return;
    struct numerics_lods exact = exact_lods(a, bias, numerics_real(a, 5));
    check_levels(&exact, numerics_real(a, 5), a[6], r, rows, a);
}

static void call_safe_levels(const uint32_t *a, uint32_t *r)
{
    struct slc_twin_levels levels =
        slc_twin_safe_levels((struct slc_twin_vec2){0.25f, 0.75f}, real2(a, 0), real2(a, 2),
                             numerics_real(a, 4), numerics_real(a, 5), a[6]);
    memcpy(r, &levels, sizeof levels);
}

static void check_safe_levels(const uint32_t *a, const uint32_t *r, bool device,
                              struct extremes_row *rows)
{
    if (device && has_nan(a, 6))
        return;
    if (has_nan(a, 4)) {
        extremes_add(&rows[0], r[0] == a[6] - 1 ? 0 : INFINITY, "NaN");
        return;
    }
    struct numerics_lods exact = exact_lods(a, numerics_real(a, 4), numerics_real(a, 5));
    check_levels(&exact, numerics_real(a, 5), a[6], r, rows, a);
}

/* Makes arguments with all exponents, and on both sides of powers of four. */
static void make_floor_log4(uint64_t i, uint32_t *a)
{
    a[0] = extremes_bits_of(fabsf(extremes_float(i)));
}

static void call_floor_log4(const uint32_t *a, uint32_t *r)
{
    r[0] = slc_twin_floor_log4(numerics_real(a, 0));
}

static void check_floor_log4(const uint32_t *a, const uint32_t *r, bool device,
                             struct extremes_row *rows)
{
    (void)device;
    float x = numerics_real(a, 0);
    uint32_t expected = 0;
    if (isnan(x))
        return;
    for (long double power = 4; power <= (long double)x && expected < 64; power *= 4)
        expected++;
    extremes_add(rows, fabs((double)r[0] - expected), "%g", (double)x);
}

static void make_ends(uint64_t i, uint32_t *a)
{
    float whole = (float)(extremes_random(i) % 18) - 1;
    float lod = extremes_float(i);
    if (i % 2)
        lod = whole + (i / 2 % 5 < 2 ? 0.125f : i / 2 % 5 < 4 ? 0.1875f : 0.0f);
    if (i % 2 && i / 16 % 3)
        lod = nextafterf(lod, i / 16 % 3 == 1 ? 99.0f : -99.0f);
    put(a, 0, lod);
    put(a, 1, i / 10 % 2 ? 0.125f : 0.1875f);
    a[2] = 1 + extremes_random(i + 1) % 16;
}

static void call_ends(const uint32_t *a, uint32_t *r)
{
    r[0] = slc_twin_finest_level(numerics_real(a, 0), numerics_real(a, 1), a[2]);
    r[1] = slc_twin_coarsest_level(numerics_real(a, 0), a[2]);
}

/* Error of the LOD that would give these levels. */
static void check_ends(const uint32_t *a, const uint32_t *r, bool device, struct extremes_row *rows)
{
    (void)device;
    long double lod = numerics_real(a, 0), last = a[2] - 1, fine = lod - numerics_real(a, 1);
    if (isnan(lod))
        return;
    long double error = 0;
    if (r[0] > 0)
        error = fmaxl(error, r[0] - fine);
    if (r[0] < last)
        error = fmaxl(error, fine - (r[0] + 1));
    long double coarse = fminl(floorl(fminl(fmaxl(lod, 0), last)) + 1, last);
    if (r[0] > last || r[1] != coarse)
        error = INFINITY;
    extremes_add(rows, (double)error, "LOD %.9g of %u", (double)lod, a[2]);
}

/* Makes all texels of a MinMip buffer, with both margins. */
static void make_shown(uint64_t i, uint32_t *a)
{
    a[0] = (uint32_t)(i & 0xFFFF);
    put(a, 1, i >> 16 & 1 ? 0.125f : 0.1875f);
}

static void call_shown(const uint32_t *a, uint32_t *r)
{
    put(r, 0, slc_twin_lod_limit(a[0], numerics_real(a, 1)));
    r[1] = slc_twin_shown_level(a[0]);
}

static void check_shown(const uint32_t *a, const uint32_t *r, bool device,
                        struct extremes_row *rows)
{
    (void)device;
    long double limit = a[0] ? (a[0] - 48.0L) / 256 + numerics_real(a, 1) : -32;
    uint32_t level = a[0] < 48 ? 0 : (a[0] - 48) / 256;
    long double error = fabsl(numerics_real(r, 0) - limit) + (r[1] != level);
    extremes_add(rows, (double)error, "texel %u", a[0]);
}

static void make_clamps(uint64_t i, uint32_t *a)
{
    put(a, 0, i % 2 ? extremes_float(i / 2) : extremes_specials[i / 2 % EXTREMES_SPECIALS]);
}

static void call_clamps(const uint32_t *a, uint32_t *r)
{
    float x = numerics_real(a, 0);
    put(r, 0, slc_twin_clamp_anisotropy(x));
    put(r, 1, slc_twin_clamp_lod(x));
    put(r, 2, slc_twin_clamp_lod_bias(x));
    put(r, 3, slc_twin_lod_margin(x));
    r[4] = slc_twin_is_finite((struct slc_twin_vec2){x, 1});
}

static void check_clamps(const uint32_t *a, const uint32_t *r, bool device,
                         struct extremes_row *rows)
{
    float x = numerics_real(a, 0);
    if (device && isnan(x))
        return;
    const long double wanted[4] = {clamped_anisotropy(x), clamped_lod(x), clamped_lod(x),
                                   x > 1 ? 0.1875L : 0.125L};
    long double error = (r[4] != 0) != (fabsf(x) <= 1e33f);
    for (uint32_t i = 0; i < COUNT_OF(wanted); i++)
        error = fmaxl(error, fabsl(numerics_real(r, i) - wanted[i]));
    extremes_add(rows, (double)error, "%g", (double)x);
}

static void call_half_box(const uint32_t *a, uint32_t *r)
{
    struct slc_twin_vec2 box =
        slc_twin_half_box(real2(a, 0), real2(a, 2), numerics_real(a, 4), numerics_real(a, 5));
    put(r, 0, box.x);
    put(r, 1, box.y);
}

/* Squares of smaller values leave the range: lengths below 2^-62 texels may be 0, above 2^63
 * infinite. */
#define BOX_LEAST 1e-18L
#define BOX_MOST 9e18L

static void check_half_box(const uint32_t *a, const uint32_t *r, bool device,
                           struct extremes_row *rows)
{
    float bias = numerics_real(a, 4);
    bool wide = numerics_real(a, 5) > 1;
    if (has_nan(a, 4) || (device && has_nan(a + 4, 2)))
        return;
    long double scale = bias <= 0 ? 1 : exp2l(clamped_lod(bias));
    for (uint32_t i = 0; i < 2; i++) {
        long double got = numerics_real(r, i);
        long double length = hypotl(numerics_real(a, i), numerics_real(a, 2 + i));
        long double error = 0;
        if (!wide || length < BOX_LEAST)
            error = got <= 2 * BOX_LEAST * scale && got >= 0 ? 0 : INFINITY;
        else if (length > BOX_MOST)
            error = got > length * scale * 0.99L || isinf(got) ? 0 : INFINITY;
        else
            error = fabsl(got / (length * scale) - 1);
        extremes_add(rows, (double)error, "%g %g bias %g", (double)numerics_real(a, i),
                     (double)numerics_real(a, 2 + i), (double)bias);
    }
}

const struct numerics_function numerics_lod[NUMERICS_LOD_COUNT] = {
    [NUMERICS_LODS] = {"compute_lods",
                       {{"finest", "levels", 7e-4, 1e-3}, {"coarsest", "levels", 7e-4, 1e-3}},
                       200000,
                       10000000,
                       make_lods,
                       call_lods,
                       check_lods},
    [NUMERICS_QUICK_LEVELS] = {"quick_levels",
                               {{"lost", "levels", 0.005, 0.005}, {"more", "levels", 2e-3, 2e-3}},
                               200000,
                               10000000,
                               make_levels,
                               call_quick_levels,
                               check_quick_levels},
    [NUMERICS_SAFE_LEVELS] = {"safe_levels",
                              {{"lost", "levels", 7e-4, 1e-3}, {"more", "levels", 7e-4, 1e-3}},
                              200000,
                              10000000,
                              make_levels,
                              call_safe_levels,
                              check_safe_levels},
    [NUMERICS_FLOOR_LOG4] = {"floor_log4",
                             {{"result", "levels", 0, 0}},
                             65536,
                             1 << 24,
                             make_floor_log4,
                             call_floor_log4,
                             check_floor_log4},
    [NUMERICS_ENDS] = {"finest_and_coarsest_level",
                       {{"result", "levels", 2e-6, 2e-6}},
                       65536,
                       1 << 24,
                       make_ends,
                       call_ends,
                       check_ends},
    [NUMERICS_SHOWN] = {"lod_limit_and_shown_level",
                        {{"result", "levels", 0, 0}},
                        1 << 17,
                        1 << 17,
                        make_shown,
                        call_shown,
                        check_shown},
    [NUMERICS_CLAMPS] = {"clamps",
                         {{"result", "absolute", 0, 1.2e-38}},
                         65536,
                         1 << 24,
                         make_clamps,
                         call_clamps,
                         check_clamps},
    [NUMERICS_HALF_BOX] = {"half_box",
                           {{"length", "relative", 1e-6, 1e-5}},
                           200000,
                           10000000,
                           make_lods,
                           call_half_box,
                           check_half_box},
};
