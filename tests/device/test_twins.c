/*
 * Compares every function of lod.glsl, footprint.glsl and stochastic.glsl with its C twin, on
 * arguments from the whole range of float, including pairs of special values.
 */
#include "device/conform.h"

#include "support/roll.h"
#include "support/test.h"
#include "vulkan/shader_twins.h"

#include "twins_comp.h"
#include "twins_shared.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define CAPACITY 16384u

static const float specials[] = {
    0.0f,     -0.0f,       1e-45f,      -1e-45f,  1e-40f,     FLT_MIN,     -FLT_MIN, 1e-20f,  0.25f,
    0.5f,     0.49999997f, 0.99999994f, 1.0f,     1.0000001f, -1.0f,       2.0f,     3.0f,    16.0f,
    31.9999f, 32.0f,       4096.0f,     1e6f,     -1e6f,      16777216.0f, 1e15f,    1.0e33f, 1e30f,
    -1e30f,   FLT_MAX,     -FLT_MAX,    INFINITY, -INFINITY,  NAN};
#define SPECIALS (sizeof specials / sizeof specials[0])

static float real(const uint32_t *a, uint32_t i)
{
    float f;
    memcpy(&f, &a[i], sizeof f);
    return f;
}

static uint32_t bits(float f)
{
    uint32_t u;
    memcpy(&u, &f, sizeof u);
    return u;
}

static struct slc_twin_vec2 real2(const uint32_t *a, uint32_t i)
{
    return (struct slc_twin_vec2){real(a, i), real(a, i + 1)};
}

static struct SluiceTextureEntry entry_of(const uint32_t *a)
{
    return (struct SluiceTextureEntry){.width = a[5],
                                       .height = a[6],
                                       .regionWidth = 1u << a[7],
                                       .regionHeight = 1u << a[8],
                                       .regionCountX = a[9],
                                       .regionCountY = a[10],
                                       .addressModeU = a[11],
                                       .addressModeV = a[12],
                                       .flags = a[13]};
}

static void call_footprint_twin(uint32_t function, const uint32_t *a, uint32_t *out)
{
    struct slc_twin_footprint f;
    struct slc_twin_vec2 box;
    struct SluiceTextureEntry e;
    switch (function) {
    case TWIN_REGION_INDEX:
        out[0] = slc_twin_region_index(real(a, 0), real(a, 1), a[2], a[3]);
        break;
    case TWIN_REGION_RANGE:
        slc_twin_region_range(real(a, 0), real(a, 1), real(a, 2), a[3], real(a, 4), a[5], a[6],
                              out);
        break;
    case TWIN_HALF_BOX:
        box = slc_twin_half_box(real2(a, 0), real2(a, 2), real(a, 4), real(a, 5));
        out[0] = bits(box.x);
        out[1] = bits(box.y);
        break;
    case TWIN_RANGE_STEP: out[0] = slc_twin_range_step(a[0], a[1], a[2], a[3]); break;
    case TWIN_NEXT_REGION: out[0] = slc_twin_next_region(a[0], a[1], a[2], a[3]); break;
    case TWIN_COMPUTE_FOOTPRINT:
        e = entry_of(a);
        f = slc_twin_compute_footprint(&e, real2(a, 0), real2(a, 2), a[4]);
        memcpy(out, f.first, sizeof f.first);
        memcpy(out + 2, f.last, sizeof f.last);
        break;
    }
}

static void call_levels_twin(uint32_t function, const uint32_t *a, uint32_t *out)
{
    struct slc_twin_squares s = {real(a, 0), real(a, 1), real(a, 2), 0};
    struct slc_twin_levels levels;
    if (function == TWIN_SQUARE_LODS) {
        s = slc_twin_square_lods(real2(a, 0), real2(a, 2), real(a, 4));
        memcpy(out, &s, sizeof s);
        return;
    }
    if (function == TWIN_QUICK_LEVELS)
        levels = slc_twin_quick_levels(s, real(a, 3), real(a, 4), a[5]);
    else
        levels = slc_twin_safe_levels(real2(a, 0), real2(a, 2), real2(a, 4), real(a, 6), real(a, 7),
                                      a[8]);
    memcpy(out, &levels, sizeof levels);
}

static void call_twin(uint32_t function, const uint32_t *a, uint32_t *out)
{
    struct slc_twin_vec2 lods;
    switch (function) {
    case TWIN_HASH: out[0] = slc_twin_hash(a[0], a[1], a[2]); break;
    case TWIN_SELECT_RANDOM_QUAD:
        out[0] = slc_twin_select_random_quad(a[0], a[1], a[2], real(a, 3));
        break;
    case TWIN_SELECT_LATTICE: out[0] = slc_twin_select_lattice(a[0], a[1], a[2]); break;
    case TWIN_SELECT_BLOCK: out[0] = slc_twin_select_block(a[0], a[1], a[2]); break;
    case TWIN_CLAMP_ANISOTROPY: out[0] = bits(slc_twin_clamp_anisotropy(real(a, 0))); break;
    case TWIN_CLAMP_LOD: out[0] = bits(slc_twin_clamp_lod(real(a, 0))); break;
    case TWIN_CLAMP_LOD_BIAS: out[0] = bits(slc_twin_clamp_lod_bias(real(a, 0))); break;
    case TWIN_IS_FINITE: out[0] = slc_twin_is_finite(real2(a, 0)); break;
    case TWIN_LOD_MARGIN: out[0] = bits(slc_twin_lod_margin(real(a, 0))); break;
    case TWIN_COMPUTE_LODS:
        lods = slc_twin_compute_lods(real2(a, 0), real2(a, 2), real(a, 4), real(a, 5));
        out[0] = bits(lods.x);
        out[1] = bits(lods.y);
        break;
    case TWIN_COMPUTE_LOD:
        out[0] = bits(slc_twin_compute_lod(real2(a, 0), real2(a, 2), real(a, 4), real(a, 5)));
        break;
    case TWIN_FINEST_LEVEL: out[0] = slc_twin_finest_level(real(a, 0), real(a, 1), a[2]); break;
    case TWIN_LOD_LIMIT: out[0] = bits(slc_twin_lod_limit(a[0], real(a, 1))); break;
    case TWIN_SHOWN_LEVEL: out[0] = slc_twin_shown_level(a[0]); break;
    case TWIN_COARSEST_LEVEL: out[0] = slc_twin_coarsest_level(real(a, 0), a[1]); break;
    case TWIN_FLOOR_LOG4: out[0] = slc_twin_floor_log4(real(a, 0)); break;
    case TWIN_SQUARE_LODS:
    case TWIN_QUICK_LEVELS:
    case TWIN_SAFE_LEVELS: call_levels_twin(function, a, out); break;
    default: call_footprint_twin(function, a, out);
    }
}

/* Returns a number: all exponents equally likely, or near 1. */
static float random_float(void)
{
    double mantissa = 1 + (double)roll() / ROLL_MAX;
    int exponent = roll() % 2 ? roll() % 276 - 149 : roll() % 12 - 8;
    return (float)((roll() % 2 ? -1 : 1) * ldexp(mantissa, exponent));
}

static uint32_t random_bits(void)
{
    return (uint32_t)roll() << 20 ^ (uint32_t)roll() << 10 ^ (uint32_t)roll();
}

static uint32_t random_count(void)
{
    return 1 + (uint32_t)roll() % (1u << roll() % 12);
}

/*
 * Kinds of arguments: u any number; f any float; F any float but NaN; P positive, 0 or NaN; t count
 * of levels; l level; m address mode; M margin; S texel of the MinMip buffer; s size, log2 of a
 * region's size and the last region; B quick LOD bias; Q square.
 */
static void random_argument(char kind, uint32_t *a)
{
    uint32_t size = random_count() * 4 + (uint32_t)roll() % 4, shift = 2 + (uint32_t)roll() % 6;
    switch (kind) {
    case 'u': a[0] = random_bits(); break;
    case 't': a[0] = 1 + (uint32_t)roll() % 15; break;
    case 'l': a[0] = (uint32_t)roll() % 15; break;
    case 'm': a[0] = (uint32_t)roll() % 5; break;
    case 'S': a[0] = random_bits() & 0xFFFF; break;
    case 'M': a[0] = bits(roll() % 2 ? 0.125f : 0.1875f); break;
    case 's':
        a[0] = bits((float)size);
        a[1] = shift;
        a[2] = ((size + (1u << shift) - 1) >> shift) - 1;
        break;
    case 'B': a[0] = bits((float)(roll() % 257 - 128) / 8.0f); break;
    case 'Q': a[0] = bits((float)ldexp(1 + (double)roll() / ROLL_MAX, roll() % 160 - 110)); break;
    case 'P': a[0] = bits(fabsf(random_float())); break;
    default: a[0] = bits(random_float());
    }
}

static void special_argument(char kind, uint32_t *a, uint32_t number)
{
    float special = specials[number % SPECIALS];
    if (kind == 'f')
        a[0] = bits(special);
    else if (kind == 'P')
        a[0] = bits(fabsf(special));
    else if (kind == 'F')
        a[0] = bits(isnan(special) ? 7.5f : special);
}

struct function {
    const char *name, *arguments;
    /// u number, x exact float, l LOD, h length, q square beside a sum, L level that rounding
    /// decides
    const char *results;
};

static const struct function functions[TWIN_COUNT] = {
    [TWIN_HASH] = {"hash", "uuu", "u"},
    [TWIN_SELECT_RANDOM_QUAD] = {"select_random_quad", "uuuf", "u"},
    [TWIN_SELECT_LATTICE] = {"select_lattice", "uuu", "u"},
    [TWIN_SELECT_BLOCK] = {"select_block", "uuu", "u"},
    [TWIN_CLAMP_ANISOTROPY] = {"clamp_anisotropy", "f", "x"},
    [TWIN_CLAMP_LOD] = {"clamp_lod", "f", "x"},
    [TWIN_CLAMP_LOD_BIAS] = {"clamp_lod_bias", "f", "x"},
    [TWIN_IS_FINITE] = {"is_finite", "ff", "u"},
    [TWIN_LOD_MARGIN] = {"lod_margin", "f", "x"},
    [TWIN_COMPUTE_LODS] = {"compute_lods", "ffffff", "ll"},
    [TWIN_COMPUTE_LOD] = {"compute_lod", "ffffff", "l"},
    [TWIN_FINEST_LEVEL] = {"finest_level", "FMt", "u"},
    [TWIN_COARSEST_LEVEL] = {"coarsest_level", "Ft", "u"},
    [TWIN_LOD_LIMIT] = {"lod_limit", "SM", "x"},
    [TWIN_SHOWN_LEVEL] = {"shown_level", "S", "u"},
    [TWIN_FLOOR_LOG4] = {"floor_log4", "P", "u"},
    [TWIN_SQUARE_LODS] = {"square_lods", "fffff", "qqqq"},
    [TWIN_QUICK_LEVELS] = {"quick_levels", "QQQBft", "LLL"},
    [TWIN_SAFE_LEVELS] = {"safe_levels", "fffffffft", "LLL"},
    [TWIN_REGION_INDEX] = {"region_index", "fs", "u"},
    [TWIN_REGION_RANGE] = {"region_range", "fPPms", "uu"},
    [TWIN_HALF_BOX] = {"half_box", "ffffff", "hh"},
    [TWIN_RANGE_STEP] = {"range_step", "", "u"},
    [TWIN_NEXT_REGION] = {"next_region", "", "u"},
    [TWIN_COMPUTE_FOOTPRINT] = {"compute_footprint", "ffPPl", "uuuu"},
};

/* Arguments that depend on each other. */
static void dependent_arguments(uint32_t function, uint32_t *a)
{
    uint32_t count = random_count();
    if (function == TWIN_RANGE_STEP || function == TWIN_NEXT_REGION) {
        a[0] = (uint32_t)roll() % count;
        a[1] = (uint32_t)roll() % count;
        a[2] = count - 1;
        a[3] = function == TWIN_RANGE_STEP ? (uint32_t)roll() % 15 : 1u << roll() % 12;
    }
    if (function == TWIN_COMPUTE_FOOTPRINT) {
        for (uint32_t i = 0; i < 2; i++) {
            a[5 + i] = 1 + (uint32_t)roll() % (1u << roll() % 15);
            a[7 + i] = 2 + (uint32_t)roll() % 7;
            a[9 + i] = (a[5 + i] + (1u << a[7 + i]) - 1) >> a[7 + i];
            a[11 + i] = (uint32_t)roll() % 5;
        }
        a[13] = (uint32_t)roll() % 2;
    }
}

/* Call i of a function: first all pairs of special values, then random ones. */
static void make_call(uint32_t function, uint32_t i, struct TwinCall *call)
{
    const char *kinds = functions[function].arguments;
    uint32_t count = (uint32_t)strlen(kinds);
    uint32_t pair = i % (SPECIALS * SPECIALS), turn = i / (SPECIALS * SPECIALS);
    *call = (struct TwinCall){0};
    for (uint32_t k = 0, slot = 0; k < count; slot += kinds[k++] == 's' ? 3 : 1)
        random_argument(kinds[k], &call->arguments[slot]);
    if (count && turn < 10) {
        uint32_t first = turn % count, second = (first + 1 + turn / count) % count;
        /* slots equal kinds, because sizes come last */
        special_argument(kinds[first], &call->arguments[first], pair % SPECIALS);
        special_argument(kinds[second], &call->arguments[second], (uint32_t)(pair / SPECIALS));
    }
    dependent_arguments(function, call->arguments);
}

/* Errors in levels against exact arithmetic: bounds of docs/numerics.md, which test_numerics and
 * test_numerics_device check. Two results may differ by the sum of both bounds. */
#define LOD_ERROR_C 7e-4
#define LOD_ERROR_DEVICE 1e-3
#define LOD_ERROR (LOD_ERROR_C + LOD_ERROR_DEVICE)

/* Relative error of a length times exp2 of the bias, by Vulkan's precision. */
static double length_error(const uint32_t *a)
{
    double bias = (double)slc_twin_clamp_lod_bias(real(a, 4));
    return (8 + 2 * fmax(bias, 0)) * (double)FLT_EPSILON;
}

/* Error of sluiceSquareLods. `widest` is half the sum plus a root of half^2 - area^2. If
 * derivatives span nearly a circle, the difference has few correct bits. */
static double square_error(const uint32_t *twin)
{
    double half = (double)real(twin, 3) / 2;
    double root = fmax((double)real(twin, 2) - half, 0);
    double lost = 4 * (double)FLT_EPSILON * half * half;
    return 2e-6 * half + lost / fmax(root, sqrt(lost));
}

static double largest_error[TWIN_COUNT];
static uint32_t rounded_levels; ///< levels that differ by one; few, because rounding seldom decides

/* Squares of smaller or larger values leave the range of float, on some devices sooner. */
static bool squares_are_ordinary(const uint32_t *a)
{
    for (uint32_t i = 0; i < 4; i++)
        if (real(a, i) != 0 && !(fabsf(real(a, i)) > 1e-18f && fabsf(real(a, i)) < 1e18f))
            return false;
    return true;
}

static bool results_agree(uint32_t function, const struct TwinCall *call, const uint32_t *twin)
{
    const char *kinds = functions[function].results;
    for (uint32_t i = 0; kinds[i]; i++) {
        float gpu = real(call->results, i), cpu = real(twin, i);
        double error = fabs((double)gpu - (double)cpu);
        switch (kinds[i]) {
        case 'l': break;
        case 'h':
            if (!squares_are_ordinary(call->arguments) || !isfinite(cpu))
                continue;
            error /= fmax((double)cpu, 1e-30);
            break;
        case 'q': /* for nearly parallel derivatives the area between them has few correct bits */
            if (!squares_are_ordinary(call->arguments) || !(real(twin, 3) < SLC_TWIN_QUICK_SQUARES))
                continue;
            if (!(error <= square_error(twin)))
                return false;
            continue;
        case 'L':
            rounded_levels += call->results[i] != twin[i];
            if (call->results[i] + 1 - twin[i] > 2)
                return false;
            continue;
        case 'x': /* a denormal may be flushed to 0 */
            if (!(error < (double)FLT_MIN))
                return false;
            continue;
        default:
            if (call->results[i] != twin[i])
                return false;
            continue;
        }
        if (!(error <= (kinds[i] == 'l' ? LOD_ERROR : length_error(call->arguments))))
            return false;
        largest_error[function] = fmax(largest_error[function], error);
    }
    return true;
}

static uint32_t flushed(uint32_t float_bits)
{
    return (float_bits & 0x7f800000u) == 0 ? float_bits & 0x80000000u : float_bits;
}

static float nudged(float x, int by)
{
    return x * (1.0f + (float)by * 4 * FLT_EPSILON);
}

/* Returns whether a range agrees if reciprocals and products are slightly off. */
static bool range_agrees_nearly(const struct SluiceTextureEntry *e, uint32_t axis, float at,
                                const float sizes[2], const uint32_t range[2])
{
    uint32_t size = axis ? e->height : e->width, out[2];
    for (int k = 0; k < 27; k++) {
        slc_twin_region_range(nudged(at, k / 9 - 1), nudged(sizes[0], k % 3 - 1),
                              nudged(sizes[1], k / 3 % 3 - 1),
                              axis ? e->addressModeV : e->addressModeU, (float)size,
                              slc_twin_shift(axis ? e->regionHeight : e->regionWidth),
                              (axis ? e->regionCountY : e->regionCountX) - 1, out);
        if (out[0] == range[0] && out[1] == range[1])
            return true;
    }
    return false;
}

static bool footprint_agrees_nearly(const struct TwinCall *call, const uint32_t *arguments)
{
    const struct SluiceTextureEntry e = entry_of(arguments);
    bool uneven = e.flags & SLUICE_TEXTURE_FLAG_UNEVEN;
    for (uint32_t axis = 0; axis < 2; axis++) {
        uint32_t size = axis ? e.height : e.width, level_size = size >> arguments[4];
        float texel = uneven ? (float)size / (float)(level_size ? level_size : 1)
                             : fminf(ldexpf(1, (int)arguments[4]), (float)size);
        float box = real(arguments, 2 + axis);
        const float sizes[2] = {(uneven ? SLC_TWIN_APRON_UNEVEN : SLC_TWIN_APRON) * texel + box,
                                SLC_TWIN_APRON * texel + box};
        const uint32_t range[2] = {call->results[axis], call->results[2 + axis]};
        if (!range_agrees_nearly(&e, axis, real(arguments, axis), sizes, range))
            return false;
    }
    return true;
}

static bool region_range_agrees_nearly(const struct TwinCall *call, const uint32_t *a)
{
    const struct SluiceTextureEntry e = {.width = (uint32_t)real(a, 4),
                                         .regionWidth = 1u << a[5],
                                         .regionCountX = a[6] + 1,
                                         .addressModeU = a[3]};
    return range_agrees_nearly(&e, 0, real(a, 0), (float[]){real(a, 1), real(a, 2)}, call->results);
}

/*
 * A position that is NaN, or infinity minus infinity, is any region, as docs/feedback.md says. In
 * Vulkan a device may replace NaN by any number, and compilers order min and max freely.
 */
static bool place_is_unknown(float at, const float sizes[2], uint32_t mode)
{
    bool wraps = mode == SLUICE_ADDRESS_MODE_REPEAT || mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT;
    if (isnan(at) || isnan(sizes[0]) || isnan(sizes[1]))
        return true;
    /* may be infinite in texels */
    return !(fabsf(at) <= 1e33f) && (wraps || isinf(sizes[0]) || isinf(sizes[1]));
}

/* Returns whether only the range of the results is known. */
static bool is_unknown(uint32_t function, const uint32_t *a)
{
    if (function == TWIN_REGION_RANGE)
        return place_is_unknown(real(a, 0), (float[]){real(a, 1), real(a, 2)}, a[3]);
    return function == TWIN_COMPUTE_FOOTPRINT &&
           (place_is_unknown(real(a, 0), (float[]){real(a, 2), 0}, a[11]) ||
            place_is_unknown(real(a, 1), (float[]){real(a, 3), 0}, a[12]));
}

/* Denormal arguments may count as 0. */
static bool call_agrees(uint32_t function, const struct TwinCall *call)
{
    uint32_t twin[TWIN_RESULTS] = {0}, arguments[TWIN_ARGUMENTS];
    call_twin(function, call->arguments, twin);
    if (is_unknown(function, call->arguments) || results_agree(function, call, twin))
        return true;
    const char *kinds = functions[function].arguments;
    memcpy(arguments, call->arguments, sizeof arguments);
    for (uint32_t i = 0; kinds[i]; i++)
        if (kinds[i] == 'f' || kinds[i] == 'F' || kinds[i] == 'P')
            arguments[i] = flushed(arguments[i]);
    call_twin(function, arguments, twin);
    if (results_agree(function, call, twin))
        return true;
    if (function == TWIN_COMPUTE_FOOTPRINT)
        return footprint_agrees_nearly(call, call->arguments) ||
               footprint_agrees_nearly(call, arguments);
    return function == TWIN_REGION_RANGE && (region_range_agrees_nearly(call, call->arguments) ||
                                             region_range_agrees_nearly(call, arguments));
}

static bool lod_is_in_range(float lod)
{
    return lod >= -SLC_TWIN_LOD_LIMIT && lod <= SLC_TWIN_LOD_LIMIT;
}

/* Checks properties that hold for any arguments. */
static bool call_is_in_range(uint32_t function, const struct TwinCall *call)
{
    const uint32_t *a = call->arguments, *r = call->results;
    switch (function) {
    case TWIN_CLAMP_ANISOTROPY: return real(r, 0) >= 1 && real(r, 0) <= 16;
    case TWIN_COMPUTE_LODS:
        return lod_is_in_range(real(r, 0)) && lod_is_in_range(real(r, 1)) &&
               real(r, 0) <= real(r, 1);
    case TWIN_CLAMP_LOD:
    case TWIN_CLAMP_LOD_BIAS:
    case TWIN_COMPUTE_LOD: return lod_is_in_range(real(r, 0));
    case TWIN_FINEST_LEVEL: return r[0] < a[2];
    case TWIN_COARSEST_LEVEL: return r[0] < a[1];
    case TWIN_QUICK_LEVELS: return r[0] < a[5] && r[1] < a[5] && r[2] < a[5];
    case TWIN_SAFE_LEVELS: return r[0] < a[8] && r[0] <= r[1] && r[1] <= r[2] && r[2] < a[8];
    case TWIN_REGION_INDEX: return r[0] <= a[3];
    case TWIN_REGION_RANGE: return r[0] <= a[6] && r[1] <= a[6];
    case TWIN_HALF_BOX: return !(real(r, 0) < 0) && !(real(r, 1) < 0);
    case TWIN_RANGE_STEP: return r[0] >= 1;
    case TWIN_NEXT_REGION: return r[0] <= a[2] && (r[0] > a[0] || r[0] == 0);
    case TWIN_COMPUTE_FOOTPRINT: return r[0] < a[9] && r[1] < a[10] && r[2] < a[9] && r[3] < a[10];
    default: return true;
    }
}

static void fail_call(uint32_t function, const struct TwinCall *call, const char *what)
{
    uint32_t twin[TWIN_RESULTS] = {0};
    call_twin(function, call->arguments, twin);
    fprintf(stderr, "# %s %s\n#", functions[function].name, what);
    for (uint32_t i = 0; i < TWIN_ARGUMENTS; i++)
        fprintf(stderr, " %.9g (%u)", (double)real(call->arguments, i), call->arguments[i]);
    for (uint32_t i = 0; i < TWIN_RESULTS; i++)
        fprintf(stderr, "\n#   device %.9g (%u), twin %.9g (%u)", (double)real(call->results, i),
                call->results[i], (double)real(twin, i), twin[i]);
    fail_msg("\n%s", functions[function].name);
}

struct caller {
    struct harness *h;
    struct harness_buffer calls;
    struct conform_set set;
    VkPipeline pipeline;
};

static void caller_init(struct caller *c, struct harness *h)
{
    c->h = h;
    harness_buffer_init(h, &c->calls, CAPACITY * sizeof(struct TwinCall),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    conform_create_set(h, 1, 0, sizeof(struct TwinParams), &c->set);
    conform_write_buffers(h, &c->set, 1, (const struct harness_buffer *const[]){&c->calls});
    c->pipeline = conform_compute_pipeline(h, c->set.layout,
                                           conform_module(h, twins_comp, sizeof twins_comp), NULL);
}

static void caller_finish(struct caller *c)
{
    c->h->DestroyPipeline(c->h->device, c->pipeline, NULL);
    conform_destroy_set(c->h, &c->set);
    harness_buffer_finish(c->h, &c->calls);
}

static void check_function(struct caller *c, uint32_t function)
{
    struct TwinCall *calls = c->calls.mapped;
    for (uint32_t i = 0; i < CAPACITY; i++)
        make_call(function, i, &calls[i]);
    struct TwinParams params = {function, CAPACITY};
    struct conform_job job = {.set = &c->set,
                              .stage = CONFORM_STAGE_COMPUTE,
                              .pipeline = c->pipeline,
                              .count = CAPACITY,
                              .push = &params,
                              .push_size = sizeof params};
    conform_run_job(c->h, &job);
    for (uint32_t i = 0; i < CAPACITY; i++) {
        if (!call_is_in_range(function, &calls[i]))
            fail_call(function, &calls[i], "is out of its range");
        if (!call_agrees(function, &calls[i]))
            fail_call(function, &calls[i], "differs from its twin");
    }
    assert_true(rounded_levels < CAPACITY / 100);
    rounded_levels = 0;
    if (largest_error[function] > 0)
        print_message("# error.%s %.3g %s\n", functions[function].name, largest_error[function],
                      function == TWIN_HALF_BOX ? "relative" : "levels");
}

static void check_functions(struct harness *h, uint32_t first, uint32_t end)
{
    struct caller c;
    caller_init(&c, h);
    roll_seed(61);
    for (uint32_t function = first; function < end; function++)
        check_function(&c, function);
    caller_finish(&c);
}

static void functions_that_select_pixels_agree(void **state)
{
    check_functions(*state, TWIN_HASH, TWIN_CLAMP_ANISOTROPY);
}

static void functions_of_the_level_of_detail_agree(void **state)
{
    check_functions(*state, TWIN_CLAMP_ANISOTROPY, TWIN_REGION_INDEX);
}

static void functions_of_the_footprint_agree(void **state)
{
    check_functions(*state, TWIN_REGION_INDEX, TWIN_COUNT);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(functions_that_select_pixels_agree),
        cmocka_unit_test(functions_of_the_level_of_detail_agree),
        cmocka_unit_test(functions_of_the_footprint_agree),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
