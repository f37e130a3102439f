/**
 * KTX2 files as image sources. Texels are returned as stored. Link `sluice-container`.
 */
#ifndef SLUICE_KTX2_H
#define SLUICE_KTX2_H

#include <sluice/image.h>
#include <sluice/input.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Settings of a source. A field of zero selects its default. */
typedef struct SluiceKtx2ImageSourceCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceKtx2ImageSourceCreateInfo).
    const char *pPath;   ///< Required without pInput. Copied.
    /**
     * Format to return. Default: the file's. Another value must name the same bytes: UNORM for
     * SRGB, BC1_RGB for BC1_RGBA, or the reverse.
     */
    SluiceFormat format;
    /** Default: malloc and free. Zstandard always uses malloc for its own memory. */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< Problems of a file, with their position.
    /** Most bytes of decompressed levels kept in memory. For Zstandard files. Default: 2^29. */
    uint64_t maxCacheSize;
    /** Reads these bytes instead of the file (input.h). Copied, but not the bytes. pPath is then a
     *  name for messages and may be NULL. Default: NULL, the file. */
    const SluiceInput *pInput;
    /** Pool that opens and closes the file as it is read (input.h). Must outlive the source. Not
     *  used with pInput. Default: NULL, the file stays open. */
    SluiceFilePool *filePool;
} SluiceKtx2ImageSourceCreateInfo;

/**
 * Creates a source for a file, without opening it. The first sluiceGetImageInfo or
 * sluiceReadImageRegion opens the file; it stays open, unless it has a filePool. An unused source
 * costs no file descriptor.
 *
 * vkFormat: any SluiceFormat, or B8G8R8A8_UNORM or _SRGB, which is converted to R8G8B8A8 when read.
 * Array layers become layers; cube maps have six layers each, and set SluiceImageInfo.cube. Rows
 * are in the file's order. KTXorientation and KTXswizzle are ignored. At most 2^20 texels in width
 * and height, and 2^16 layers.
 *
 * Supercompression: none or Zstandard. Without it, a read touches only its own bytes. Zstandard
 * compresses each level as a whole: the first read of a level decompresses it, while other readers
 * of that level wait. The level is kept; the least recently read levels are dropped to stay within
 * maxCacheSize. During decompression the compressed bytes are in memory as well. For streaming,
 * prefer files without supercompression (`ktx create` without --zstd).
 *
 * A file may have any number of levels; mipLevelCount says how many. A level count of 0 in the file
 * means one level. SluiceImageInfo says how many levels streaming requires.
 * sluiceCreateCompleteChainSource adds missing levels of uncompressed formats. Write files of
 * compressed formats with all levels (ktx create --generate-mipmap).
 *
 * Queries and reads return SLUICE_NOT_READY while the process has too few file descriptors to open
 * the file. Sluice leaves the last 16 below the soft limit to others.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for an unknown format and a
 *         pInput whose size is out of range; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Errors of queries and reads: SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_IO;
 *         SLUICE_ERROR_CORRUPT_DATA for contradictory headers, truncated files and levels that
 *         decompress to a wrong size or fail to decompress; SLUICE_ERROR_UNSUPPORTED for Basis
 *         Universal (ETC1S, UASTC), ZLIB, other formats, a `format` of different bytes, volumes,
 *         1D textures, a level larger than maxCacheSize, and Zstandard in a build without it;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. Each error is logged once, at most 16 per file, with the
 *         file's name and a remedy. The next call tries again.
 * Thread safety: any thread.
 * Source: Khronos, "KTX File Format Specification", version 2.0.
 */
SLUICE_API SluiceResult sluiceCreateKtx2ImageSource(const SluiceKtx2ImageSourceCreateInfo *pInfo,
                                                    SluiceImageSource **pSource);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_KTX2_H */
