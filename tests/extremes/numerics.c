#include "extremes/numerics.h"

#include "support/test.h"

#include <sluice/shared/texture_table.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

const struct numerics_function *numerics_find(uint32_t function)
{
    if (function < NUMERICS_LOD_COUNT)
        return &numerics_lod[function];
    function -= NUMERICS_LOD_COUNT;
    if (function < NUMERICS_REGION_COUNT)
        return &numerics_regions[function];
    return &numerics_pages[function - NUMERICS_REGION_COUNT];
}

void numerics_begin(const struct numerics_function *f, bool device,
                    struct extremes_row rows[NUMERICS_ROWS])
{
    for (uint32_t i = 0; i < NUMERICS_ROWS; i++)
        rows[i] =
            (struct extremes_row){.name = f->errors[i].name,
                                  .unit = f->errors[i].unit,
                                  .bound = device ? f->errors[i].device_bound : f->errors[i].bound};
}

void numerics_end(const struct numerics_function *f, bool device,
                  struct extremes_row rows[NUMERICS_ROWS])
{
    char name[80];
    for (uint32_t i = 0; i < NUMERICS_ROWS && f->errors[i].name; i++) {
        snprintf(name, sizeof name, "%s.%s.%s", device ? "device" : "c", f->name,
                 f->errors[i].name);
        rows[i].name = name;
        extremes_end(&rows[i]);
    }
}

float numerics_real(const uint32_t *words, uint32_t i)
{
    return extremes_float_of(words[i]);
}

bool numerics_are_finite(const uint32_t *words, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (!(fabsf(numerics_real(words, i)) <= 1e33f))
            return false;
    return true;
}

/* The ellipse's axes are the singular values of the matrix of derivatives. */
struct numerics_lods numerics_exact_lods(const float dx[2], const float dy[2],
                                         long double anisotropy)
{
    long double ax = dx[0], ay = dx[1], bx = dy[0], by = dy[1];
    long double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, dot = ax * bx + ay * by;
    long double root = sqrtl((a2 - b2) * (a2 - b2) + 4 * dot * dot);
    long double major = sqrtl((a2 + b2 + root) / 2);
    long double minor = major > 0 ? fabsl(ax * by - ay * bx) / major : 0;
    long double longer = sqrtl(fmaxl(a2, b2)), shorter = sqrtl(fminl(a2, b2));
    long double n = anisotropy;
    struct numerics_lods lods = {.longer = longer, .minor = minor};
    minor = fminl(minor, shorter);
    lods.finest = log2l(n > 1 ? fmaxl(minor, longer / n) : longer);
    lods.coarsest = log2l(n > 1 ? fmaxl(shorter, major / n) : major);
    lods.isotropic = log2l(major);
    return lods;
}

long double numerics_exact_fold(float coordinate, uint32_t mode)
{
    long double c = coordinate;
    switch (mode) {
    case SLUICE_ADDRESS_MODE_REPEAT: return c - floorl(c);
    case SLUICE_ADDRESS_MODE_MIRRORED_REPEAT: c = fabsl(fmodl(c, 2)); return c > 1 ? 2 - c : c;
    case SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE: c = fabsl(c); break;
    }
    return c < 0 ? 0 : c > 1 ? 1 : c;
}

/* 0 to 1 */
static double draw(uint64_t number)
{
    return (double)extremes_random(number) / 4294967296.0;
}

static void set(uint32_t *words, double ax, double ay, double bx, double by)
{
    const double values[4] = {ax, ay, bx, by};
    for (uint32_t i = 0; i < 4; i++)
        words[i] = extremes_bits_of((float)values[i]);
}

/* Lengths next to powers of two, at any angles to each other. */
static void make_footprint(uint64_t i, uint32_t *words)
{
    double length = exp2((int)(extremes_random(i * 8 + 1) % 40) - 12);
    length *= i / 4 % 3 ? 1 + ((int)(i / 4 % 9) - 4) * 0x1p-23 : exp2(draw(i * 8 + 2));
    double ratio = exp2(draw(i * 8 + 3) * 7);
    if (i / 4 % 5 == 0)
        ratio = (double)(i % 20);
    if (i / 4 % 5 == 1) /* nearly a circle */
        ratio = 1 + draw(i * 8 + 6) * exp2(-(int)(i / 20 % 26));
    double angle = i / 4 % 7 ? draw(i * 8 + 4) * 6.3 : 0;
    double turn = i / 8 % 3 == 0 ? 1.5707963267948966 : draw(i * 8 + 5) * exp2(-(int)(i / 4 % 30));
    set(words, length * cos(angle), length * sin(angle), ratio * length * cos(angle + turn),
        ratio * length * sin(angle + turn));
}

void numerics_make_derivatives(uint64_t i, uint32_t *words)
{
    const uint64_t pairs = (uint64_t)EXTREMES_SPECIALS * EXTREMES_SPECIALS;
    if (i % 4) {
        make_footprint(i, words);
        return;
    }
    i /= 4;
    for (uint32_t k = 0; k < 4; k++)
        words[k] = extremes_bits_of(extremes_float(i * 4 + k * 131 + k));
    if (i >= 6 * pairs)
        return;
    static const uint8_t slots[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    uint64_t pair = i % pairs;
    for (uint32_t k = 0; k < 4; k++)
        words[k] = extremes_bits_of((float)(i % 3));
    words[slots[i / pairs][0]] = extremes_bits_of(extremes_specials[pair % EXTREMES_SPECIALS]);
    words[slots[i / pairs][1]] = extremes_bits_of(extremes_specials[pair / EXTREMES_SPECIALS]);
}

float numerics_make_coordinate(uint64_t i)
{
    if (i % 2)
        return extremes_float(i / 2);
    double near = (int)(extremes_random(i) % 9) - 4; /* a border of the image, and beside it */
    switch (i / 2 % 4) {
    case 0: return extremes_specials[i / 8 % EXTREMES_SPECIALS];
    case 1: return (float)(near / 2 + (draw(i + 1) - 0.5) * exp2(-(int)(i / 8 % 30)));
    case 2: return nextafterf((float)(near / 2), i / 8 % 2 ? 1e9f : -1e9f);
    default: return (float)(draw(i + 2) * 6 - 3);
    }
}

float numerics_make_bias(uint64_t i)
{
    if (i % 3 == 0)
        return 0;
    return i % 3 == 1 ? (float)((int)(extremes_random(i) % 257) - 128) / 8 : extremes_float(i / 3);
}

float numerics_make_anisotropy(uint64_t i)
{
    if (i % 4 == 0)
        return extremes_float(i / 4);
    return i % 4 == 1 ? 1 : (float)(1 << extremes_random(i) % 5);
}

uint32_t numerics_make_size(uint64_t i)
{
    static const uint32_t sizes[] = {1, 2, 3, 16384, 16383, 8191, 1023, 1025, 65536, 12289};
    uint32_t random = extremes_random(i);
    return i % 2 ? sizes[random % (sizeof sizes / sizeof sizes[0])]
                 : 1 + (random >> 8) % (1u << random % 16);
}
