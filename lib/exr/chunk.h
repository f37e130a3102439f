/** Positions of the chunks (tiles or blocks of lines) in the file. */
#ifndef SLC_EXR_CHUNK_H
#define SLC_EXR_CHUNK_H

#include "exr/exr_file.h"

/** Chunk and the region of its level. */
struct slc_exr_chunk {
    exr_chunk_info_t info;
    SluiceImageRegion region; ///< in the file's level; the file may round sizes up, Vulkan does not
};

/**
 * Finds the chunk in column `x` and row `y` of a level's chunks and reads its leader. Errors: IO,
 * CORRUPT_DATA, OUT_OF_HOST_MEMORY; logged. Thread safety: any thread.
 */
SluiceResult slc_exr_chunk_find(struct slc_exr_file *file, uint32_t level, uint32_t x, uint32_t y,
                                struct slc_exr_chunk *chunk);

#endif /* SLC_EXR_CHUNK_H */
