/** Figures over the frames of a run, from its frames.csv, reduced to the resolution of a plot. */
#ifndef SLUICE_TRADEOFF_PAGE_SERIES_H
#define SLUICE_TRADEOFF_PAGE_SERIES_H

#include <stdio.h>

#include "page_choose.h"

#define PAGE_BINS_MAX 400 ///< per column; more frames are merged

/**
 * Writes an object: {"runs": [{"point", "frames", "step", "columns": [{"name", "least", "most"}]}],
 * "left_out": [{"point", "why"}]}, with runs in the order of `choices`. A number stands for `step`
 * frames. `least` is missing if `step` is 1. Runs beyond `size_max` bytes are left out. Returns
 * false when out of memory.
 */
bool page_put_series(FILE *file, const struct sweep *sweep, const struct page_choice *choices,
                     uint32_t choice_count, size_t size_max);

#endif /* SLUICE_TRADEOFF_PAGE_SERIES_H */
