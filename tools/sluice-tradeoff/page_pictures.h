/** Pictures of some frames of the most telling runs: what was drawn, the truth, the difference. */
#ifndef SLUICE_TRADEOFF_PAGE_PICTURES_H
#define SLUICE_TRADEOFF_PAGE_PICTURES_H

#include <stdio.h>

#include "page_choose.h"

#define PAGE_FRAMES_PER_RUN 3 ///< the run's worst, the base's worst, the base's middling one

/**
 * Puts an object: {"pool": [{"width", "height", "png": base64}], "sets": [{"point", "frame",
 * "streamed", "truth", "flip", "role", "metric"}], "left_out": [{"point", "frame", "why"}]}.
 * streamed, truth and flip are indices into the pool, -1 where there is no picture; a picture that
 * several runs share is in it once. The worst frames of all runs come first, and a frame that would
 * not fit into `size_max` bytes is left out. False when out of memory.
 */
bool page_put_pictures(FILE *file, const struct sweep *sweep, const struct page_choice *choices,
                       uint32_t choice_count, size_t size_max);

#endif /* SLUICE_TRADEOFF_PAGE_PICTURES_H */
