/**
 * Shared by tests of extremes: numbers from the whole range of float, and a line per result:
 *
 *     # extremes: name | cases | worst, and where | bound
 *
 * scripts/lib/collect.py makes a table of these lines. A program has a quick form, and with --long
 * a form with many more cases.
 */
#ifndef TESTS_EXTREMES_EXTREMES_H
#define TESTS_EXTREMES_EXTREMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Reads the program's arguments: none, or --long. Returns false for others, with a message. */
bool extremes_begin(int argc, char **argv);
bool extremes_are_long(void);
/** Returns `quick`, or `many` in the long form. */
uint64_t extremes_count(uint64_t quick, uint64_t many);

/** The largest error of a function. Fields other than name, unit and bound begin as 0. */
struct extremes_row {
    const char *name, *unit;
    double bound;
    uint64_t cases;
    double worst;
    char at[160]; ///< case of the largest error
};

/** Counts a case. NaN is the largest error. The printf arguments name the case. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void extremes_add(struct extremes_row *row, double error, const char *format, ...);

/** Prints the row. Fails the test if the row has no case or exceeds its bound. */
void extremes_end(const struct extremes_row *row);

#define EXTREMES_SPECIALS 26u
/** Special values: both zeros, denormals, FLT_MIN, values around 1, 1e6, 1e30, FLT_MAX, infinities
 * and NaN. */
extern const float extremes_specials[EXTREMES_SPECIALS];

/** Returns 32 bits of a hash of the number, equal on every machine. */
uint32_t extremes_random(uint64_t number);

/** Returns float `i` of a series. 512 of them have each exponent with both signs, including NaN and
 * infinities. The first mantissas are the smallest, its neighbors and the largest, then any. */
float extremes_float(uint64_t i);

float extremes_float_of(uint32_t bits);
uint32_t extremes_bits_of(float value);

#endif /* TESTS_EXTREMES_EXTREMES_H */
