/** The part of astcenc, a C++ library, that the baker uses. */
#ifndef SLC_BAKE_BLOCK_ASTC_H
#define SLC_BAKE_BLOCK_ASTC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum slc_astc_quality { SLC_ASTC_FAST, SLC_ASTC_MEDIUM, SLC_ASTC_THOROUGH };

/**
 * Creates tables for blocks of `extent` x `extent` texels. NULL: no memory.
 * Thread safety: one thread at a time.
 */
void *slc_astc_open(uint32_t extent, bool srgb, enum slc_astc_quality quality);
void slc_astc_close(void *context);

/** Encodes [height][width] RGBA bytes to `size` bytes of blocks. Returns false without memory. */
bool slc_astc_compress(void *context, uint8_t *rgba, uint32_t width, uint32_t height, void *blocks,
                       size_t size);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLC_BAKE_BLOCK_ASTC_H */
