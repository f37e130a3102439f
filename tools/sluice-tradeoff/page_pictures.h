/** Pictures of some frames of the most interesting runs: streamed, truth, and difference. */
#ifndef SLUICE_TRADEOFF_PAGE_PICTURES_H
#define SLUICE_TRADEOFF_PAGE_PICTURES_H

#include <stdio.h>

#include "page_choose.h"

#define PAGE_FRAMES_PER_RUN 3 ///< the run's worst, the base's worst and its middle one

/**
 * Writes an object: {"pool": [{"width", "height", "png": base64}], "sets": [{"point", "frame",
 * "streamed", "truth", "flip", "role", "metric"}], "left_out": [{"point", "frame", "why"}]}.
 * streamed, truth and flip are indices in the pool, -1 without a picture. Equal pictures are in the
 * pool once. The worst frames of all runs come first. Frames beyond `size_max` bytes are left out.
 * Returns false when out of memory.
 */
bool page_put_pictures(FILE *file, const struct sweep *sweep, const struct page_choice *choices,
                       uint32_t choice_count, size_t size_max);

#endif /* SLUICE_TRADEOFF_PAGE_PICTURES_H */
