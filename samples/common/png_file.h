/** Pictures as PNG files. */
#ifndef SAMPLES_COMMON_PNG_FILE_H
#define SAMPLES_COMMON_PNG_FILE_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Writes [height][width] RGBA bytes, row 0 on top, as an opaque sRGB picture. Says on stderr why it
 * failed. After an error the path is as it was before; see output_file.h.
 */
bool png_file_write(const char *path, const uint8_t *rgba, uint32_t width, uint32_t height);

/** [height][width] RGBA bytes for the caller to free. NULL if it failed, and stderr says why. */
uint8_t *png_file_read(const char *path, uint32_t *width, uint32_t *height);

#endif /* SAMPLES_COMMON_PNG_FILE_H */
