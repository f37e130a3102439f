/** Writer of PNG files, row by row, so that the picture need not be in memory. */
#ifndef TOOLS_SLUICE_INFO_PNG_ROWS_H
#define TOOLS_SLUICE_INFO_PNG_ROWS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct png_rows;

/**
 * Begins a picture of RGBA bytes, sRGB. `path` appears in messages and must outlive the rows.
 * Returns NULL on error. All functions here report errors on stderr.
 */
struct png_rows *png_rows_begin(FILE *out, const char *path, uint32_t width, uint32_t height);

/** Writes the next `count` rows, [count][width][4]. */
bool png_rows_write(struct png_rows *rows, const uint8_t *rgba, uint32_t count);

/** Frees the rows. `whole`: ends the file, after the last row. */
bool png_rows_end(struct png_rows *rows, bool whole);

#endif /* TOOLS_SLUICE_INFO_PNG_ROWS_H */
