/* Regions under a sample, and pixels that write feedback. */
#include "extremes/numerics.h"

#include "vulkan/shader_twins.h"

#include <math.h>

/* Arguments 0 to 2: position, below, above; 3: address mode; 4: size; 5, 6: log2 of a region,
 * last. */
static void make_axis(uint64_t i, uint32_t *a)
{
    uint32_t size = numerics_make_size(i), shift = 2 + extremes_random(i + 1) % 7;
    a[0] = extremes_bits_of(numerics_make_coordinate(i));
    a[3] = extremes_random(i + 2) % 5;
    a[4] = extremes_bits_of((float)size);
    a[5] = shift;
    a[6] = ((size + (1u << shift) - 1) >> shift) - 1;
}

static void make_region_range(uint64_t i, uint32_t *a)
{
    make_axis(i, a);
    float texel = exp2f((float)(extremes_random(i + 3) % 15));
    float box = i % 3 ? 0 : fabsf(extremes_float(i / 3)), apron = i % 5 ? 0.5625f : 1.5625f;
    a[1] = extremes_bits_of(apron * texel + box);
    a[2] = extremes_bits_of(0.5625f * texel + box);
    const uint64_t pairs = (uint64_t)EXTREMES_SPECIALS * EXTREMES_SPECIALS;
    if (i < 5 * pairs) { /* special values in all modes */
        uint64_t pair = i % pairs;
        a[0] = extremes_bits_of(extremes_specials[pair % EXTREMES_SPECIALS]);
        a[1] = a[2] = extremes_bits_of(fabsf(extremes_specials[pair / EXTREMES_SPECIALS]));
        a[3] = (uint32_t)(i / pairs);
    }
}

static void call_region_range(const uint32_t *a, uint32_t *r)
{
    slc_twin_region_range(numerics_real(a, 0), numerics_real(a, 1), numerics_real(a, 2), a[3],
                          numerics_real(a, 4), a[5], a[6], r);
}

/* Distance of a position in [0, size] from a region, in texels. */
static long double distance(long double place, uint32_t region, const uint32_t *a)
{
    long double width = 1u << a[5], low = region * width, high = low + width;
    if (region == a[6])
        high = fmaxl(high, numerics_real(a, 4));
    return place < low ? low - place : place > high ? place - high : 0;
}

/* Distance from a region where the image repeats. */
static long double distance_around(long double place, uint32_t region, const uint32_t *a)
{
    long double size = numerics_real(a, 4), nearest = INFINITY;
    place -= size * floorl(place / size);
    for (int turn = -1; turn <= 1; turn++)
        nearest = fminl(nearest, distance(place + turn * size, region, a));
    return nearest;
}

static long double clamped(long double x, long double high)
{
    return x < 0 ? 0 : x > high ? high : x;
}

/* Errors in texels that a float resolves at 16384. Larger images and boxes scale the error. */
static void add_places(const uint32_t *a, long double error, long double reach,
                       struct extremes_row *rows)
{
    extremes_add(rows, (double)(error / fmaxl(1, reach / 16384)),
                 "%.9g of %g texels, mode %u, %g before, %g behind", (double)numerics_real(a, 0),
                 (double)numerics_real(a, 4), a[3], (double)numerics_real(a, 1),
                 (double)numerics_real(a, 2));
}

static void check_region_range(const uint32_t *a, const uint32_t *r, bool device,
                               struct extremes_row *rows)
{
    (void)device;
    if (r[0] > a[6] || r[1] > a[6])
        extremes_add(rows, INFINITY, "a region outside");
    if (!numerics_are_finite(a, 3))
        return;
    long double c = numerics_real(a, 0), size = numerics_real(a, 4);
    long double below = numerics_real(a, 1), above = numerics_real(a, 2);
    bool repeats = a[3] == SLUICE_ADDRESS_MODE_REPEAT;
    if (repeats && r[0] == 0 && r[1] == a[6] && below + above >= size - (1u << a[5])) {
        add_places(a, 0, 1, rows); /* all of it, as promised */
        return;
    }
    if (a[3] == SLUICE_ADDRESS_MODE_REPEAT || a[3] == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT)
        c = numerics_exact_fold(numerics_real(a, 0), a[3]);
    else if (a[3] == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE)
        c = fabsl(c);
    if (!repeats && a[3] != SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE &&
        a[3] != SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER)
        below = above = fmaxl(below, above);
    long double low = c * size - below, high = c * size + above, error;
    if (repeats)
        error = fmaxl(distance_around(low, r[0], a), distance_around(high, r[1], a));
    else
        error =
            fmaxl(distance(clamped(low, size), r[0], a), distance(clamped(high, size), r[1], a));
    add_places(a, error, fabsl(c) * size + below + above, rows);
}

/* Argument 7: address mode of the other axis. */
static void make_quick_region(uint64_t i, uint32_t *a)
{
    make_axis(i, a);
    a[1] = a[2] = 0;
    a[7] = i % 3 ? a[3] : extremes_random(i + 5) % 5;
}

static void check_quick_region(const uint32_t *a, const uint32_t *r, bool device,
                               struct extremes_row *rows)
{
    (void)device;
    if (r[0] > a[6])
        extremes_add(rows, INFINITY, "a region outside");
    if (!numerics_are_finite(a, 1))
        return;
    long double size = numerics_real(a, 4);
    long double place = numerics_exact_fold(numerics_real(a, 0), a[3]) * size;
    bool repeats = a[3] == SLUICE_ADDRESS_MODE_REPEAT;
    add_places(a, repeats ? distance_around(place, r[0], a) : distance(place, r[0], a), size, rows);
}

/* Mixes three words as stochastic.glsl documents, in arithmetic modulo 2^32. */
static uint32_t mixed(uint64_t x, uint64_t y, uint64_t z)
{
    const uint64_t modulus = 1ull << 32;
    uint64_t h =
        (x * 0x9E3779B1u + y * 0x85EBCA77u % modulus + z * 0xC2B2AE3Du % modulus) % modulus;
    h = (h ^ h / 32768) * 0x2C1B3C6Du % modulus;
    return (uint32_t)((h ^ h / 8192) * 0x297A2D39u % modulus);
}

/* Adds the half pixel on the host: a compiler that saw the addition might fold it into others. */
static void add_fragment_place(uint32_t *a)
{
    for (uint32_t axis = 0; axis < 2; axis++)
        a[4 + axis] = extremes_bits_of((float)a[axis] + 0.5f);
}

static void make_select_random(uint64_t i, uint32_t *a)
{
    uint32_t random = extremes_random(i);
    a[0] = random >> 3 & 0x3FFFFF; /* fragments: below 2^22 */
    a[1] = extremes_random(i + 1) >> (i % 4 ? 20 : 10) & 0x3FFFFF;
    if (i % 16 == 3)
        a[0] = i % 32 == 3 ? 0x3FFFFF : (uint32_t)(i / 32) & 0x3FFFFF;
    a[2] = i % 3 ? extremes_random(i + 2) : (uint32_t)(i / 3);
    uint32_t draw = mixed((a[0] >> 1) + 0x4B000000u, (a[1] >> 1) + 0x4B000000u, a[2]) >> 9;
    float exact = (float)draw / 8388608.0f; /* the draw itself, and its neighbors */
    float any = i % 7 ? exp2f(-(float)(extremes_random(i + 3) % 24)) : extremes_float(i / 7);
    float near = i % 8 < 2 ? exact : nextafterf(exact, i % 8 < 4 ? 2.0f : -1.0f);
    a[3] = extremes_bits_of(i % 8 < 6 ? near : any);
    add_fragment_place(a);
}

static void call_select_random(const uint32_t *a, uint32_t *r)
{
    r[0] = r[1] = slc_twin_select_random_quad(a[0], a[1], a[2], numerics_real(a, 3));
}

static void check_select_random(const uint32_t *a, const uint32_t *r, bool device,
                                struct extremes_row *rows)
{
    float p = numerics_real(a, 3);
    if (device && (isnan(p) || (p != 0 && fabsf(p) < 0x1p-126f)))
        return;
    uint32_t draw = mixed((a[0] >> 1) + 0x4B000000u, (a[1] >> 1) + 0x4B000000u, a[2]) >> 9;
    bool selected = draw / 8388608.0L < (long double)p;
    /* Some drivers move the 1 to the other side, which rounds p to a multiple of 2^-23. */
    if (device && p > 0 && p < 1 && fabsl(draw / 8388608.0L - (long double)p) < 0x1p-23L &&
        p * 8388608.0f != floorf(p * 8388608.0f))
        return;
    extremes_add(rows, (r[0] != selected) + (r[1] != selected), "pixel %u %u, seed %u, %.9g", a[0],
                 a[1], a[2], (double)p);
}

static void make_select_lattice(uint64_t i, uint32_t *a)
{
    a[0] = (uint32_t)(i % 64) / 8 + (i % 5 ? 0 : extremes_random(i / 64) >> 10 & ~7u);
    a[1] = (uint32_t)(i % 8) + (i % 3 ? 0 : extremes_random(i / 64 + 9) >> 10 & ~7u);
    a[2] = i % 2 ? (uint32_t)(i / 64) : extremes_random(i / 64);
    add_fragment_place(a);
}

static void call_select_lattice(const uint32_t *a, uint32_t *r)
{
    r[0] = r[1] = slc_twin_select_lattice(a[0], a[1], a[2]);
}

/* Order of frames in an 8x8 block: halves, quarters and eighths in turn, with x shifted by y. */
static void check_select_lattice(const uint32_t *a, const uint32_t *r, bool device,
                                 struct extremes_row *rows)
{
    (void)device;
    uint32_t x = 0, y = 0;
    for (uint32_t bit = 0; bit < 3; bit++) {
        x += (a[2] >> 2 * bit) % 2 * (4 >> bit);
        y += (a[2] >> (2 * bit + 1)) % 2 * (4 >> bit);
    }
    bool selected = a[0] % 8 == (x ^ y) && a[1] % 8 == y;
    extremes_add(rows, (r[0] != selected) + (r[1] != selected), "pixel %u %u, frame %u", a[0], a[1],
                 a[2]);
}

#define AT(i) [(i)-NUMERICS_LOD_COUNT]

/* Footprints have an apron of 1/16 texel for the device's coordinates and for this error. */
const struct numerics_function numerics_regions[NUMERICS_REGION_COUNT] = {
    AT(NUMERICS_REGION_RANGE) = {"region_range",
                                 {{"place", "texels of 16384", 0.004, 0.004}},
                                 300000,
                                 10000000,
                                 make_region_range,
                                 call_region_range,
                                 check_region_range},
    AT(NUMERICS_QUICK_REGION) = {"quick_region",
                                 {{"place", "texels of 16384", 0.004, 0.004}},
                                 200000,
                                 10000000,
                                 make_quick_region,
                                 NULL,
                                 check_quick_region},
    AT(NUMERICS_SELECT_RANDOM) = {"select_random",
                                  {{"result", "decisions", 0, 0}},
                                  200000,
                                  1 << 24,
                                  make_select_random,
                                  call_select_random,
                                  check_select_random},
    AT(NUMERICS_SELECT_LATTICE) = {"select_lattice",
                                   {{"result", "decisions", 0, 0}},
                                   1 << 18,
                                   1 << 24,
                                   make_select_lattice,
                                   call_select_lattice,
                                   check_select_lattice},
};
