/** Numbers in the text of files, read the same in every locale. */
#ifndef SLC_BASE_TEXT_NUMBER_H
#define SLC_BASE_TEXT_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Reads a decimal number: digits, at most one point, and an exponent. Returns the first byte behind
 * it, or `text` if there is no number. The text ends with a byte that is part of no number.
 *
 * Right to the last bit if it has at most 15 digits and an exponent of at most 22; otherwise to
 * about 1e-15 of its value. May be infinite.
 */
const unsigned char *slc_read_number(const unsigned char *text, double *number);

/** Reads [+-]digits that fit in 32 bits. Returns `text` if there are none or they do not fit. */
const unsigned char *slc_read_integer(const unsigned char *text, int32_t *number);

#endif /* SLC_BASE_TEXT_NUMBER_H */
