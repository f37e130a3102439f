/** PNG files of a material, a mosaic, to compress as a neural set. */
#ifndef SAMPLES_STREAMING_MATERIAL_FILES_H
#define SAMPLES_STREAMING_MATERIAL_FILES_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Makes a folder and writes albedo.png (sRGB), height.png and roughness.png (gray) of `size` x
 * `size` texels. Overwrites existing files. Reports errors on stderr.
 */
bool material_files_write(const char *folder, uint32_t size);

#endif /* SAMPLES_STREAMING_MATERIAL_FILES_H */
