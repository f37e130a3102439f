/** A PNG file that is written row by row, so that a picture need not be in memory. */
#ifndef TOOLS_SLUICE_INFO_PNG_ROWS_H
#define TOOLS_SLUICE_INFO_PNG_ROWS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct png_rows;

/**
 * Begins a picture of RGBA bytes, sRGB. `path` stands in messages and lives as long as the rows.
 * NULL if it failed. Every function here says on stderr why it failed.
 */
struct png_rows *png_rows_begin(FILE *out, const char *path, uint32_t width, uint32_t height);

/** The next `count` rows, [count][width][4]. */
bool png_rows_write(struct png_rows *rows, const uint8_t *rgba, uint32_t count);

/** Frees the rows; with `whole`, after the last row, ends the file. */
bool png_rows_end(struct png_rows *rows, bool whole);

#endif /* TOOLS_SLUICE_INFO_PNG_ROWS_H */
