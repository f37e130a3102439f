/**
 * What tests of extremes share: numbers from all of the range of float, and a line per result:
 *
 *     # extremes: name | cases | worst, and where | bound
 *
 * which scripts/lib/collect.py makes a table of. A program has a quick form and, with --long, one
 * of many more cases.
 */
#ifndef TESTS_EXTREMES_EXTREMES_H
#define TESTS_EXTREMES_EXTREMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Reads the program's arguments: nothing, or --long. False, having said so, if there are others.
 */
bool extremes_begin(int argc, char **argv);
bool extremes_are_long(void);
/** `quick`, or `many` in the long form. */
uint64_t extremes_count(uint64_t quick, uint64_t many);

/** The largest error of a function; all but name, unit and bound begin as 0. */
struct extremes_row {
    const char *name, *unit;
    double bound;
    uint64_t cases;
    double worst;
    char at[160]; ///< the case that it was found in
};

/** Counts a case. NaN is the largest error. printf arguments say which case it is. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void extremes_add(struct extremes_row *row, double error, const char *format, ...);

/** Prints the row, and fails the test if it has no case or exceeds its bound. */
void extremes_end(const struct extremes_row *row);

#define EXTREMES_SPECIALS 26u
/** Both zeros, denormals, FLT_MIN, around 1, 1e6, 1e30, FLT_MAX, infinities and NaN. */
extern const float extremes_specials[EXTREMES_SPECIALS];

/** 32 bits, of a hash of the number: the same on every machine. */
uint32_t extremes_random(uint64_t number);

/** Float `i` of a series: in 512 of them each exponent with both signs, NaN and infinities among
 *  them; of mantissas the smallest, its neighbors and the largest first, then any. */
float extremes_float(uint64_t i);

float extremes_float_of(uint32_t bits);
uint32_t extremes_bits_of(float value);

#endif /* TESTS_EXTREMES_EXTREMES_H */
