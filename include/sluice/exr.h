/**
 * OpenEXR files as image sources, through the C API of OpenEXRCore. Link `sluice-exr`.
 *
 * Tiled files with mip levels are read tile by tile where they are asked for; nothing else of the
 * file is touched. Scanline files and tiled files without levels are read once, at the first read,
 * and their chain is built by a box filter and kept in memory. Rip-mapped files use the levels on
 * the diagonal.
 */
#ifndef SLUICE_EXR_H
#define SLUICE_EXR_H

#include <sluice/image.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceExrImageSourceCreateInfo {
    const char *pPath; ///< required; copied
    /**
     * Format delivered, UNDEFINED for what fits the file: R16_SFLOAT or R32_SFLOAT for one channel,
     * R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT for more, by the widest channel. Conversion to
     * half saturates at +-65504; to 8 bits clamps to [0, 1], sRGB encodes; NaN becomes 0. Float
     * formats keep infinities and NaN as they are in the file, and so do half ones where the file
     * has halves; chains built here treat NaN as 0.
     */
    SluiceFormat format;
    /** NULL: malloc and free. What OpenEXRCore needs itself is always from malloc. */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< what is wrong with a file, and where
    uint64_t maxImageSize; ///< bytes of level 0 beyond which a file is refused; 0: 2^34
    /** The source has level 0 alone (mipLevelCount is 1), and any file is read where it is asked
     *  for, chunk by chunk: no chain is built and nothing is kept in memory. */
    bool levelZeroAlone;
} SluiceExrImageSourceCreateInfo;

/**
 * Opens a file and reads its header.
 *
 * Channels any of R, G, B, A (missing R, G and B: 0, missing A: 1) or Y (grey, with A: grey with
 * alpha) of type half, float or uint. Formats of fewer components take the first ones; a file of
 * one channel read as one component gives that channel, whatever its name. The data window is the
 * image, at most 2^20 texels in either direction; where it starts does not matter. Of levels that
 * were rounded up, the last row and column beyond Vulkan's size are dropped.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT for unknown, compressed and PACK32 formats;
 *         FILE_NOT_FOUND, IO, CORRUPT_DATA; UNSUPPORTED for deep data, multi-part
 *         files whose first part is not such an image, luminance-chroma, layers or other channel
 *         names, subsampling; OUT_OF_HOST_MEMORY. The log callback gets file, value and what to do.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateExrImageSource(const SluiceExrImageSourceCreateInfo *pInfo,
                                                   SluiceImageSource **pSource);

/** Zero in any field asks for the default written beside it. */
typedef struct SluiceExrWriteInfo {
    const char *pPath;    ///< required; the file is complete or absent
    uint32_t tileWidth;   ///< 0: 128
    uint32_t tileHeight;  ///< 0: 128
    uint32_t threadCount; ///< 0: 1
    bool uncompressed;    ///< else ZIP
    bool opaque;          ///< leave A out
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log;
    void *pUserData;
    /** NULL, or called now and then from one thread at a time; false stops: CANCELLED. */
    bool (*pfnProgress)(void *pUserData, uint64_t doneTexels, uint64_t totalTexels);
} SluiceExrWriteInfo;

/**
 * Writes every level of a source as a tiled, mip-mapped file (ROUND_DOWN) of half channels: Y for
 * sources of one channel, R and G for two, R, G, B and A for four. sRGB sources become linear; half
 * ones keep their bits, others are rounded to nearest and saturate at +-65504.
 *
 * Tiles are made on threadCount threads, the caller's among them, and written in order; memory is
 * a few tiles per thread and 8 bytes per tile of the file. The allocator is called from all of
 * them. The file is written under another name beside `pPath` and renamed when it is complete.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT for tiles of more than 2^24 texels and sources without a
 *         full chain; UNSUPPORTED beyond 2^20 texels in a direction; LIMIT_EXCEEDED beyond 2^31
 * tiles; IO; OUT_OF_HOST_MEMORY; CANCELLED; and whatever but success the source answers, NOT_READY
 * among it. No file is left then. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceWriteExrFile(const SluiceExrWriteInfo *pInfo,
                                           SluiceImageSource *source);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_EXR_H */
