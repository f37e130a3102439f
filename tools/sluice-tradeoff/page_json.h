/** JSON for the script element of an HTML page. */
#ifndef SLUICE_TRADEOFF_PAGE_JSON_H
#define SLUICE_TRADEOFF_PAGE_JSON_H

#include <stdio.h>

#include "sweep.h"

/** Writes a string with its quotes, or null. Escapes '<', so that the string cannot end the
 * element. */
void page_put_text(FILE *file, const char *text);
/** Writes at most five digits in at most `PAGE_NUMBER_SIZE` characters. NaN becomes null;
 * infinities become "inf" and "-inf". */
void page_put_number(FILE *file, double value);
#define PAGE_NUMBER_SIZE 12

/** Writes an object of settings, metrics, points and recommendations. */
void page_put_sweep(FILE *file, const struct sweep *sweep,
                    const struct sweep_recommendation *recommendations, uint32_t count);

#endif /* SLUICE_TRADEOFF_PAGE_JSON_H */
