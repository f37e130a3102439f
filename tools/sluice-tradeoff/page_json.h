/** Pieces of JSON that may stand inside an HTML page's script element. */
#ifndef SLUICE_TRADEOFF_PAGE_JSON_H
#define SLUICE_TRADEOFF_PAGE_JSON_H

#include <stdio.h>

#include "sweep.h"

/** A string with its quotes; no '<' is in it, so that it ends no element. NULL: null. */
void page_put_text(FILE *file, const char *text);
/** Five digits at most `PAGE_NUMBER_SIZE` letters; null for NaN, "inf" and "-inf" with quotes. */
void page_put_number(FILE *file, double value);
#define PAGE_NUMBER_SIZE 12

/** Settings, metrics, all points, recommendations: an object. */
void page_put_sweep(FILE *file, const struct sweep *sweep,
                    const struct sweep_recommendation *recommendations, uint32_t count);

#endif /* SLUICE_TRADEOFF_PAGE_JSON_H */
