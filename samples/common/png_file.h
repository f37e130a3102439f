/** PNG files. */
#ifndef SAMPLES_COMMON_PNG_FILE_H
#define SAMPLES_COMMON_PNG_FILE_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Writes [height][width] RGBA bytes, row 0 on top, as an opaque sRGB picture. Reports errors on
 * stderr. After an error the path is unchanged; see output_file.h.
 */
bool png_file_write(const char *path, const uint8_t *rgba, uint32_t width, uint32_t height);

/** Reads a file to [height][width] RGBA bytes. Free the result. Reports errors on stderr and
 * returns NULL. */
uint8_t *png_file_read(const char *path, uint32_t *width, uint32_t *height);

#endif /* SAMPLES_COMMON_PNG_FILE_H */
