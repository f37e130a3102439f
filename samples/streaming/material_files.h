/** A material of our own as PNG files, to be compressed as a neural set: a mosaic. */
#ifndef SAMPLES_STREAMING_MATERIAL_FILES_H
#define SAMPLES_STREAMING_MATERIAL_FILES_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Writes albedo.png (sRGB), height.png and roughness.png (gray) of `size` x `size` texels into a
 * folder, which is made. Files that are there are written again. Says on stderr why it failed.
 */
bool material_files_write(const char *folder, uint32_t size);

#endif /* SAMPLES_STREAMING_MATERIAL_FILES_H */
