#include "extremes/extremes.h"

#include "support/test.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool long_form;

const float extremes_specials[EXTREMES_SPECIALS] = {
    0.0f,        -0.0f,    0x1p-149f, -0x1p-149f,  0x1.fffffcp-127f,
    FLT_MIN,     -FLT_MIN, 1e-20f,    0x1.fep-2f,  0.5f,
    0.99999994f, 1.0f,     -1.0f,     1.0000001f,  2.0f,
    -1.0000001f, 1e6f,     -1e6f,     16777216.0f, 1e30f,
    -1e30f,      FLT_MAX,  -FLT_MAX,  INFINITY,    -INFINITY,
    NAN};

bool extremes_begin(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--long") != 0) {
            fprintf(stderr, "usage: %s [--long]\n", argv[0]);
            return false;
        }
        long_form = true;
    }
    return true;
}

bool extremes_are_long(void)
{
    return long_form;
}

uint64_t extremes_count(uint64_t quick, uint64_t many)
{
    return long_form ? many : quick;
}

void extremes_add(struct extremes_row *row, double error, const char *format, ...)
{
    if (isnan(error))
        error = INFINITY;
    if (row->cases++ && !(error > row->worst))
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(row->at, sizeof row->at, format, arguments);
    va_end(arguments);
    row->worst = error;
}

void extremes_end(const struct extremes_row *row)
{
    const char *place = row->worst > 0 ? row->at : "";
    print_message("# extremes: %s | %llu | %.3g %s%s%s | %.3g %s\n", row->name,
                  (unsigned long long)row->cases, row->worst, row->unit, place[0] ? " at " : "",
                  place, row->bound, row->unit);
    if (!row->cases)
        fail_msg("%s: no case", row->name);
    if (!(row->worst <= row->bound))
        fail_msg("%s: %g %s at %s, beyond %g", row->name, row->worst, row->unit, row->at,
                 row->bound);
}

/* SplitMix64. */
uint32_t extremes_random(uint64_t number)
{
    uint64_t z = number * 0x9E3779B97F4A7C15u + 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return (uint32_t)((z ^ z >> 31) >> 32);
}

float extremes_float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

uint32_t extremes_bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

float extremes_float(uint64_t i)
{
    static const uint32_t mantissas[] = {0, 1, 0x7FFFFF, 0x7FFFFE, 0x400000, 0x3504F3};
    uint64_t turn = i / 512;
    uint32_t mantissa = turn < sizeof mantissas / sizeof mantissas[0]
                            ? mantissas[turn]
                            : extremes_random(i) & 0x7FFFFF;
    return extremes_float_of((uint32_t)(i % 512) << 23 | mantissa);
}
