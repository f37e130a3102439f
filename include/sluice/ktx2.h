/**
 * KTX2 files as image sources: what is in the file is what is delivered. Link `sluice-container`.
 */
#ifndef SLUICE_KTX2_H
#define SLUICE_KTX2_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceKtx2ImageSourceCreateInfo {
    const char *pPath; ///< required; copied
    /** UNDEFINED: the file's. Otherwise another name for the same bytes: UNORM for SRGB and the
     *  reverse, BC1_RGB for BC1_RGBA and the reverse. */
    SluiceFormat format;
    /** NULL: malloc and free. What Zstandard needs itself is always from malloc. */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< what is wrong with a file, and where
    /** Bytes of decompressed levels that are kept, of files compressed as a whole; 0: 2^29. */
    uint64_t maxCacheSize;
} SluiceKtx2ImageSourceCreateInfo;

/**
 * Names a file. It is opened at the first sluiceGetImageInfo or sluiceReadImageRegion and stays
 * open: a source that nobody asks costs no descriptor and no read.
 *
 * vkFormat is any SluiceFormat, or B8G8R8A8_UNORM or _SRGB, which becomes R8G8B8A8 as it is read.
 * Array layers come as layers, the faces of cube maps as six for each of them. Rows are in the
 * file's order; KTXorientation and KTXswizzle are not looked at. At most 2^20 texels in a
 * direction, 2^16 layers.
 *
 * Supercompression: none, where a read touches its own bytes alone, or Zstandard, where a level is
 * compressed as a whole. Such a level is decompressed at the first read in it, with other readers
 * of that level waiting, and kept; levels that were read longest ago give way when more than
 * maxCacheSize would be kept. While a level is decompressed its compressed bytes are in memory,
 * too. For streaming, files without supercompression are the better choice: `ktx create` without
 * --zstd.
 *
 * The chain must be full, down to one texel, because coarse levels are what streaming falls back
 * to. A file that ends earlier is UNSUPPORTED: write it again with all levels (ktx create
 * --generate-mipmap).
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT for unknown formats; OUT_OF_HOST_MEMORY.
 *         From the first query or read on: FILE_NOT_FOUND, IO; CORRUPT_DATA for headers that
 *         contradict themselves, files shorter than they say and levels that do not decompress to
 *         what they should; UNSUPPORTED for Basis Universal (ETC1S, UASTC) and ZLIB, other formats,
 *         a `format` of other bytes, incomplete chains, volumes, 1D textures, a level larger than
 *         maxCacheSize, and Zstandard in a build without it; OUT_OF_HOST_MEMORY. Each is logged
 *         with the file's name and what to do; the next call tries again.
 * Thread safety: any thread.
 * Source: Khronos, "KTX File Format Specification", version 2.0.
 */
SLUICE_API SluiceResult sluiceCreateKtx2ImageSource(const SluiceKtx2ImageSourceCreateInfo *pInfo,
                                                    SluiceImageSource **pSource);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_KTX2_H */
