/** The frames of a run that there are pictures of, and how bad they are. */
#ifndef SLUICE_TRADEOFF_PAGE_SHOTS_H
#define SLUICE_TRADEOFF_PAGE_SHOTS_H

#include <stdbool.h>
#include <stdint.h>

#define PAGE_SHOTS_MAX 512 ///< frames with pictures that are looked at, per run

struct page_shots {
    uint32_t frames[PAGE_SHOTS_MAX]; ///< numbers, the worst first; unknown ones last, in turn
    uint32_t count;
};

/**
 * Looks for frame-NNNN.png, and orders them by the column flip of frames.csv if that knows all of
 * them, else by psnr_db. A folder that cannot be read has none. False when out of memory.
 */
bool page_shots_get(struct page_shots *shots, const char *folder);

#endif /* SLUICE_TRADEOFF_PAGE_SHOTS_H */
