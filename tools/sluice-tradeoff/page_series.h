/** Figures over the frames of a run, from its frames.csv, decimated to what a plot can show. */
#ifndef SLUICE_TRADEOFF_PAGE_SERIES_H
#define SLUICE_TRADEOFF_PAGE_SERIES_H

#include <stdio.h>

#include "page_choose.h"

#define PAGE_BINS_MAX 400 ///< per column; more frames than that are put together

/**
 * Puts an object: {"runs": [{"point", "frames", "step", "columns": [{"name", "least", "most"}]}],
 * "left_out": [{"point", "why"}]}, runs in the order of `choices`. A number stands for `step`
 * frames; `least` is missing where that is 1. Runs that would not fit into `size_max` bytes are
 * left out. False when out of memory.
 */
bool page_put_series(FILE *file, const struct sweep *sweep, const struct page_choice *choices,
                     uint32_t choice_count, size_t size_max);

#endif /* SLUICE_TRADEOFF_PAGE_SERIES_H */
