/** Frames of a run that have pictures, sorted by error. */
#ifndef SLUICE_TRADEOFF_PAGE_SHOTS_H
#define SLUICE_TRADEOFF_PAGE_SHOTS_H

#include <stdbool.h>
#include <stdint.h>

#define PAGE_SHOTS_MAX 512 ///< maximum number of frames per run; further ones are ignored

struct page_shots {
    uint32_t frames[PAGE_SHOTS_MAX]; ///< numbers, the worst first; unknown ones last, in order
    uint32_t count;
};

/**
 * Finds frame-NNNN.png. Sorts by the column flip of frames.csv if it has all frames, else by
 * psnr_db. A folder that cannot be read has none. Returns false when out of memory.
 */
bool page_shots_get(struct page_shots *shots, const char *folder);

#endif /* SLUICE_TRADEOFF_PAGE_SHOTS_H */
