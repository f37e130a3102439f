/*
 * Every function of lod.glsl, footprint.glsl and stochastic.glsl against its C twin, on arguments
 * from all of the range of float, pairs of special values among them.
 */
#include "device/conform.h"

#include "support/test.h"
#include "vulkan/shader_twins.h"

#include "twins_comp.h"
#include "twins_shared.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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
                                       .regionWidth = a[7],
                                       .regionHeight = a[8],
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
    memcpy(f.x, a, sizeof f.x);
    memcpy(f.y, a + 3, sizeof f.y);
    switch (function) {
    case TWIN_REGION_INDEX: out[0] = slc_twin_region_index(real(a, 0), real(a, 1), a[2]); break;
    case TWIN_REGION_RANGE:
        slc_twin_region_range(real(a, 0), real(a, 1), real(a, 2), a[3], real(a, 4), a[5], out);
        break;
    case TWIN_HALF_BOX:
        box = slc_twin_half_box(real2(a, 0), real2(a, 2), real(a, 4), real(a, 5));
        out[0] = bits(box.x);
        out[1] = bits(box.y);
        break;
    case TWIN_RANGE_SHIFT: out[0] = slc_twin_range_shift(a, a[3]); break;
    case TWIN_COUNT_STEPS: out[0] = slc_twin_count_steps(a[0], a[3]); break;
    case TWIN_RANGE_STEPS: out[0] = slc_twin_range_steps(a, a[3]); break;
    case TWIN_RANGE_REGION: out[0] = slc_twin_range_region(a, a[3], a[4]); break;
    case TWIN_COMPUTE_FOOTPRINT:
        e = entry_of(a);
        f = slc_twin_compute_footprint(&e, real2(a, 0), real2(a, 2), a[4]);
        memcpy(out, f.x, sizeof f.x);
        memcpy(out + 3, f.y, sizeof f.y);
        break;
    case TWIN_IS_ONE_REGION: out[0] = slc_twin_footprint_is_one_region(&f); break;
    case TWIN_FOOTPRINT_STEPS:
        out[0] = slc_twin_range_steps(f.x, a[6]);
        out[1] = slc_twin_range_steps(f.y, a[6]);
        break;
    case TWIN_FOOTPRINT_REGION:
        out[0] = slc_twin_range_region(f.x, a[6], a[7]);
        out[1] = slc_twin_range_region(f.y, a[6], a[8]);
        break;
    }
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
    default: call_footprint_twin(function, a, out);
    }
}

/* All exponents alike, or somewhere near 1. */
static float random_float(void)
{
    double mantissa = 1 + (double)rand() / RAND_MAX;
    int exponent = rand() % 2 ? rand() % 276 - 149 : rand() % 12 - 8;
    return (float)((rand() % 2 ? -1 : 1) * ldexp(mantissa, exponent));
}

static uint32_t random_bits(void)
{
    return (uint32_t)rand() << 20 ^ (uint32_t)rand() << 10 ^ (uint32_t)rand();
}

/* A range of regions of a texture that has `count` of them, as sluiceRegionRange returns them. */
static void random_range(uint32_t *a, uint32_t count)
{
    a[0] = (uint32_t)rand() % count;
    a[1] = a[0] + (uint32_t)rand() % (count - a[0]);
    a[2] = a[1];
    if (rand() % 3 == 0) {
        a[1] = count - 1;
        a[2] = (uint32_t)rand() % count;
        a[0] = a[2] == a[1] ? 0 : a[0];
    }
}

static uint32_t random_count(void)
{
    return 1 + (uint32_t)rand() % (1u << rand() % 12);
}

/*
 * Kinds of arguments: u any number, f any float, F any but NaN, P any that is positive or 0 or NaN,
 * t a count of levels, l a level, m an address mode, M a margin, S a texel of the MinMip buffer, s
 * regions per unit and their count.
 */
static void random_argument(char kind, uint32_t *a)
{
    uint32_t size = random_count() * 4 + (uint32_t)rand() % 4, region = 4u << rand() % 6;
    switch (kind) {
    case 'u': a[0] = random_bits(); break;
    case 't': a[0] = 1 + (uint32_t)rand() % 15; break;
    case 'l': a[0] = (uint32_t)rand() % 15; break;
    case 'm': a[0] = (uint32_t)rand() % 5; break;
    case 'S': a[0] = random_bits() & 0xFFFF; break;
    case 'M': a[0] = bits(rand() % 2 ? 0.125f : 0.1875f); break;
    case 's':
        a[0] = bits((float)size / (float)region);
        a[1] = (size + region - 1) / region;
        break;
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
    const char *results; ///< u number, x exact float, l LOD, h length
};

static const struct function functions[TWIN_COUNT] = {
    [TWIN_HASH] = {"hash", "uuu", "u"},
    [TWIN_SELECT_RANDOM_QUAD] = {"select_random_quad", "uuuf", "u"},
    [TWIN_SELECT_LATTICE] = {"select_lattice", "uuu", "u"},
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
    [TWIN_REGION_INDEX] = {"region_index", "fs", "u"},
    [TWIN_REGION_RANGE] = {"region_range", "fPPms", "uuu"},
    [TWIN_HALF_BOX] = {"half_box", "ffffff", "hh"},
    [TWIN_RANGE_SHIFT] = {"range_shift", "", "u"},
    [TWIN_COUNT_STEPS] = {"count_steps", "", "u"},
    [TWIN_RANGE_STEPS] = {"range_steps", "", "u"},
    [TWIN_RANGE_REGION] = {"range_region", "", "u"},
    [TWIN_COMPUTE_FOOTPRINT] = {"compute_footprint", "ffPPl", "uuuuuu"},
    [TWIN_IS_ONE_REGION] = {"is_one_region", "", "u"},
    [TWIN_FOOTPRINT_STEPS] = {"footprint_steps", "", "uu"},
    [TWIN_FOOTPRINT_REGION] = {"footprint_region", "", "uu"},
};

/* Arguments that only make sense together. */
static void dependent_arguments(uint32_t function, uint32_t *a)
{
    if (function >= TWIN_RANGE_SHIFT && function <= TWIN_RANGE_REGION) {
        random_range(a, random_count());
        a[3] = (uint32_t)rand() % 15;
        a[4] = (uint32_t)rand() % slc_twin_range_steps(a, a[3]);
    }
    if (function >= TWIN_IS_ONE_REGION) {
        random_range(a, random_count());
        random_range(a + 3, random_count());
        a[6] = (uint32_t)rand() % 15;
        a[7] = (uint32_t)rand() % slc_twin_range_steps(a, a[6]);
        a[8] = (uint32_t)rand() % slc_twin_range_steps(a + 3, a[6]);
    }
    if (function == TWIN_COMPUTE_FOOTPRINT) {
        for (uint32_t i = 0; i < 2; i++) {
            a[5 + i] = 1 + (uint32_t)rand() % (1u << rand() % 15);
            a[7 + i] = 4u << rand() % 7;
            a[9 + i] = (a[5 + i] + a[7 + i] - 1) / a[7 + i];
            a[11 + i] = (uint32_t)rand() % 5;
        }
        a[13] = (uint32_t)rand() % 2;
    }
}

/* Call i of a function: pairs of special values first, all of them, then anything. */
static void make_call(uint32_t function, uint32_t i, struct TwinCall *call)
{
    const char *kinds = functions[function].arguments;
    uint32_t count = (uint32_t)strlen(kinds);
    uint32_t pair = i % (SPECIALS * SPECIALS), turn = i / (SPECIALS * SPECIALS);
    *call = (struct TwinCall){0};
    for (uint32_t k = 0, slot = 0; k < count; slot += kinds[k++] == 's' ? 2 : 1)
        random_argument(kinds[k], &call->arguments[slot]);
    if (count && turn < 10) {
        uint32_t first = turn % count, second = (first + 1 + turn / count) % count;
        /* slots are those of kinds, as sizes come last */
        special_argument(kinds[first], &call->arguments[first], pair % SPECIALS);
        special_argument(kinds[second], &call->arguments[second], (uint32_t)(pair / SPECIALS));
    }
    dependent_arguments(function, call->arguments);
}

/* In levels: log2 of Vulkan, and what is lost where derivatives are nearly parallel. */
#define LOD_ERROR 1e-4

/* Relative, of a length times exp2 of the bias, by the precision that Vulkan asks for. */
static double length_error(const uint32_t *a)
{
    double bias = (double)slc_twin_clamp_lod_bias(real(a, 4));
    return (8 + 2 * fmax(bias, 0)) * (double)FLT_EPSILON;
}

static double largest_error[TWIN_COUNT];

/* Squares of what is smaller or larger leave the range of float, on some devices sooner. */
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
        case 'x': /* a denormal may be 0 */
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

/* Whether the twin agrees once reciprocals and products are off by a little more or less. */
static bool footprint_agrees_nearly(const struct TwinCall *call, const uint32_t *arguments)
{
    const struct SluiceTextureEntry e = entry_of(arguments);
    for (uint32_t axis = 0; axis < 2; axis++) {
        uint32_t size = axis ? e.height : e.width, level_size = size >> arguments[4];
        uint32_t region = axis ? e.regionHeight : e.regionWidth, out[3];
        float texel = 1.0f / (float)(level_size ? level_size : 1), box = real(arguments, 2 + axis);
        float apron = e.flags & SLUICE_TEXTURE_FLAG_UNEVEN ? SLC_TWIN_APRON_UNEVEN : SLC_TWIN_APRON;
        bool found = false;
        for (int k = 0; k < 9 && !found; k++) {
            slc_twin_region_range(real(arguments, axis), nudged(apron * texel + box, k % 3 - 1),
                                  nudged(SLC_TWIN_APRON * texel + box, k / 3 - 1),
                                  axis ? e.addressModeV : e.addressModeU,
                                  (float)size / (float)region,
                                  axis ? e.regionCountY : e.regionCountX, out);
            found = memcmp(out, call->results + 3 * axis, sizeof out) == 0;
        }
        if (!found)
            return false;
    }
    return true;
}

/*
 * A place that is NaN, or infinity minus infinity, is some region, as docs/feedback.md says: in
 * Vulkan a device may take NaN for any number, and each compiler orders min and max as it likes.
 */
static bool place_is_unknown(float at, const float sizes[2], uint32_t mode)
{
    bool wraps = mode == SLUICE_ADDRESS_MODE_REPEAT || mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT;
    if (isnan(at) || isnan(sizes[0]) || isnan(sizes[1]))
        return true;
    return isinf(at) && (wraps || isinf(sizes[0]) || isinf(sizes[1]));
}

/* Then only the range of the results is known. */
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
    return function == TWIN_COMPUTE_FOOTPRINT && (footprint_agrees_nearly(call, call->arguments) ||
                                                  footprint_agrees_nearly(call, arguments));
}

static bool lod_is_in_range(float lod)
{
    return lod >= -SLC_TWIN_LOD_LIMIT && lod <= SLC_TWIN_LOD_LIMIT;
}

/* What holds for any arguments. */
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
    case TWIN_REGION_INDEX: return r[0] < a[2];
    case TWIN_REGION_RANGE: return r[0] <= r[1] && r[1] < a[5] && r[2] < a[5];
    case TWIN_HALF_BOX: return !(real(r, 0) < 0) && !(real(r, 1) < 0);
    case TWIN_RANGE_REGION: return r[0] <= a[1] && (r[0] >= a[0] || a[2] != a[1]);
    case TWIN_COMPUTE_FOOTPRINT:
        return r[0] <= r[1] && r[1] < a[9] && r[2] < a[9] && r[3] <= r[4] && r[4] < a[10] &&
               r[5] < a[10];
    case TWIN_FOOTPRINT_REGION: return r[0] <= a[1] && r[1] <= a[4];
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
                                           conform_module(h, twins_comp, sizeof twins_comp));
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
    if (largest_error[function] > 0)
        print_message("# error.%s %.3g %s\n", functions[function].name, largest_error[function],
                      function == TWIN_HALF_BOX ? "relative" : "levels");
}

static void check_functions(struct harness *h, uint32_t first, uint32_t end)
{
    struct caller c;
    caller_init(&c, h);
    srand(61);
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
