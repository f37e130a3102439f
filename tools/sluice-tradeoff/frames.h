/** Reads frames.csv of a run: a line per frame. */
#ifndef SLUICE_TRADEOFF_FRAMES_H
#define SLUICE_TRADEOFF_FRAMES_H

#include "figures.h"

#include <stdint.h>

/** Zeroed is empty. */
struct frames {
    char **names;   ///< names of the columns; owned
    double *values; ///< [row][column]; NaN: empty, or not a number; owned
    size_t column_count, row_count;
};

/** Returns false and sets errno if the file cannot be read. A file without lines has no columns. */
bool frames_read(const char *path, struct frames *frames);
/** Returns the column's index. -1: there is no such column. */
int frames_column(const struct frames *frames, const char *name);
/**
 * Adds figures over all frames, unless the program printed them: mean PSNR (of the mean squared
 * error), mean SSIM and FLIP, and the share of pixels that lack levels.
 */
void frames_derive(const struct frames *frames, struct figures *figures);
void frames_finish(struct frames *frames);

#endif /* SLUICE_TRADEOFF_FRAMES_H */
