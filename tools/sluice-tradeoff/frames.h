/** frames.csv of a run: a line per frame. */
#ifndef SLUICE_TRADEOFF_FRAMES_H
#define SLUICE_TRADEOFF_FRAMES_H

#include "figures.h"

#include <stdint.h>

/** Zeroed is empty. */
struct frames {
    char **names;   ///< of the columns; owned
    double *values; ///< [row][column]; NaN: nothing, or no number, stands there; owned
    size_t column_count, row_count;
};

/** False with errno if the file cannot be read; a file without a line has no columns. */
bool frames_read(const char *path, struct frames *frames);
/** -1: there is no such column. */
int frames_column(const struct frames *frames, const char *name);
/**
 * Adds figures over all frames that the program did not print itself: mean PSNR (of the mean
 * squared error), SSIM and FLIP, and the share of pixels that miss levels.
 */
void frames_derive(const struct frames *frames, struct figures *figures);
void frames_finish(struct frames *frames);

#endif /* SLUICE_TRADEOFF_FRAMES_H */
