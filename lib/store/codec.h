/** Compression with zstd, with memory from the caller's allocator. */
#ifndef SLC_STORE_CODEC_H
#define SLC_STORE_CODEC_H

#include <sluice/base.h>

struct slc_store_compressor;   /* a ZSTD_CCtx */
struct slc_store_decompressor; /* a ZSTD_DCtx */

/** Creates a compressor. NULL without memory. `cb` must outlive it. */
struct slc_store_compressor *slc_store_compressor_create(const SluiceAllocationCallbacks *cb);
/** NULL is allowed. */
void slc_store_compressor_destroy(struct slc_store_compressor *compressor);

/**
 * Compresses to one zstd frame of fewer than `size` bytes in `out`, which has room for `size` - 1
 * bytes. Writes its size to *out_size; 0 if the frame would be larger. Errors: OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_store_compress(struct slc_store_compressor *compressor, int level,
                                const void *texels, size_t size, void *out, size_t *out_size);

/** Creates a decompressor, like slc_store_compressor_create. Slow on virtual machines, because zstd
 *  queries the processor's features. */
struct slc_store_decompressor *slc_store_decompressor_create(const SluiceAllocationCallbacks *cb);
void slc_store_decompressor_destroy(struct slc_store_decompressor *decompressor);

/**
 * Decompresses a frame of exactly `texel_size` bytes. Errors: OUT_OF_HOST_MEMORY; CORRUPT_DATA,
 * with the reason in `message`, a constant string.
 */
SluiceResult slc_store_decompress(struct slc_store_decompressor *decompressor, const void *bytes,
                                  size_t size, void *texels, size_t texel_size,
                                  const char **message);

#endif /* SLC_STORE_CODEC_H */
