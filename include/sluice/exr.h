/**
 * OpenEXR files as image sources, read through OpenEXRCore. Link `sluice-exr`.
 *
 * Tiled files with mip levels are read tile by tile, on demand. Scanline files and tiled files
 * without levels are read once, at the first read; their mip chain is built by a box filter and
 * kept in memory, at most maxMemorySize. For larger files bake a tile store (bake.h, `sluice-bake
 * FILE -o DIR`). Of rip-mapped files the levels on the diagonal are used.
 */
#ifndef SLUICE_EXR_H
#define SLUICE_EXR_H

#include <sluice/image.h>
#include <sluice/input.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Default memory limit of one source: 512 MiB. */
#define SLUICE_EXR_DEFAULT_MEMORY_SIZE ((uint64_t)1 << 29)
/** Default memory limit of all sources of a memory budget: 1 GiB. */
#define SLUICE_EXR_DEFAULT_MEMORY_BUDGET ((uint64_t)1 << 30)

/** Memory limit that several sources share for the mip levels that they build. */
typedef struct SluiceExrMemoryBudget SluiceExrMemoryBudget;

/**
 * Creates a budget of `maxSize` bytes. 0 means SLUICE_EXR_DEFAULT_MEMORY_BUDGET. A NULL
 * `pAllocator` means malloc and free.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread. Sources on different threads may share one budget.
 */
SLUICE_API SluiceResult sluiceCreateExrMemoryBudget(uint64_t maxSize,
                                                    const SluiceAllocationCallbacks *pAllocator,
                                                    SluiceExrMemoryBudget **pBudget);

/**
 * Destroys a budget. Destroy every source that uses it first. NULL is allowed.
 * Thread safety: external on `budget`.
 */
SLUICE_API void sluiceDestroyExrMemoryBudget(SluiceExrMemoryBudget *budget);

/** Settings of a source. A field of zero selects its default. */
typedef struct SluiceExrImageSourceCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceExrImageSourceCreateInfo).
    const char *pPath;   ///< Required without pInput. Copied.
    /**
     * Format of the texels that the source returns. Default: UNDEFINED, which selects a float
     * format by the widest channel of the file: R16_SFLOAT or R32_SFLOAT for one channel,
     * R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT for more.
     *
     * Half formats saturate at +-65504. UNORM formats clamp to [0, 1] and sRGB formats encode; NaN
     * becomes 0. Float formats keep infinities and NaN of the file; half formats do if the file's
     * channels are half. Mip levels built here treat NaN as 0.
     *
     * R32_UINT, R32G32_UINT and R32G32B32A32_UINT return the numbers of uint channels exactly, for
     * ids of objects and materials. Float formats round numbers above 2^24. Integers are never
     * averaged: a texel of a coarser level is one of the finer texels.
     */
    SluiceFormat format;
    /** Default: malloc and free. OpenEXRCore always uses malloc for its own memory. */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< Problems of a file, with their position.
    uint64_t maxImageSize; ///< Largest level 0 accepted, in bytes. Default: 2^34.
    /**
     * Provide level 0 only (mipLevelCount is 1). Any file is then read on demand, chunk by chunk.
     * No mip chain is built, and nothing is kept in memory.
     */
    bool levelZeroAlone;
    /**
     * Most bytes of memory that the source may use: for levels built from a file without levels,
     * and for decoding the largest chunk on one thread. A file that needs more is refused when it
     * is opened, with SLUICE_ERROR_LIMIT_EXCEEDED and a log message that says how much it needs.
     * Tiled files with levels and tile stores (bake.h) need a few MiB. Default:
     * SLUICE_EXR_DEFAULT_MEMORY_SIZE, or all of `memoryBudget` if set.
     */
    uint64_t maxMemorySize;
    /**
     * Budget that the memory for mip levels is taken from at creation and returned to at
     * destruction. Must outlive the source. A source that exceeds what is left is refused with
     * SLUICE_ERROR_LIMIT_EXCEEDED. Default: NULL, no shared budget.
     */
    SluiceExrMemoryBudget *memoryBudget;
    /**
     * Return R, G and B as stored in the file, ignoring `chromaticities`. For normal maps and other
     * data, and for programs that convert colors themselves.
     */
    bool keepPrimaries;
    /** Reads these bytes instead of the file (input.h). Copied, but not the bytes. pPath is then a
     *  name for messages and may be NULL. Default: NULL, the file. */
    const SluiceInput *pInput;
    /** Pool that opens and closes the file as it is read (input.h). Must outlive the source. Not
     *  used with pInput. Default: NULL, the file stays open. */
    SluiceFilePool *filePool;
} SluiceExrImageSourceCreateInfo;

/**
 * Opens a file and reads its header.
 *
 * Channels: any of R, G, B and A, or, in a file without R, G and B, Y (gray) with or without A.
 * Types: half, float, uint. Missing R, G and B read as 0, missing A as 1. Other channels, such as Z
 * and layers, are skipped with a message at SLUICE_LOG_INFO. A format of fewer components takes the
 * first ones. If the file has one such channel, a one-component format returns that channel.
 *
 * Size: the data window is the image, at most 2^20 texels wide and high. Its origin is ignored. If
 * the file rounds level sizes up, the last row and column beyond Vulkan's size are dropped.
 *
 * Color: if the file has an attribute `chromaticities` or `adoptedNeutral`, R, G and B of type half
 * and float are converted to the primaries and white of Rec. ITU-R BT.709, unless the file uses
 * those already or keepPrimaries is set. The white of `adoptedNeutral`, else the file's white,
 * becomes R = G = B by Bradford adaptation to D65. Files in CIE XYZ are not adapted. Colors that
 * contain a NaN or an infinity are not converted, nor are gray, single channels and alpha.
 * `whiteLuminance` is not applied.
 *
 * Returns SLUICE_NOT_READY, without a source, while the process has too few file descriptors.
 * Sluice leaves the last 16 below the soft limit to others. Close files and call again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for unknown, compressed, PACK32
 *         and SNORM formats, for integer formats other than the three above, and for a pInput whose
 *         size is out of range;
 *         SLUICE_ERROR_FILE_NOT_FOUND, SLUICE_ERROR_IO, SLUICE_ERROR_CORRUPT_DATA;
 *         SLUICE_ERROR_UNSUPPORTED for deep data, subsampling, luminance-chroma, an integer format
 *         of a file whose channels are not all uint, more than 1024 channels, files with only
 *         layers or other channel names, and multi-part files whose first part is unsupported;
 *         SLUICE_ERROR_LIMIT_EXCEEDED if more memory is needed than maxMemorySize or memoryBudget
 *         allow; SLUICE_ERROR_OUT_OF_HOST_MEMORY. The log message names the file, the value and a
 *         remedy.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateExrImageSource(const SluiceExrImageSourceCreateInfo *pInfo,
                                                   SluiceImageSource **pSource);

/** Storage layout of a file. */
typedef enum SluiceExrStorage {
    SLUICE_EXR_STORAGE_SCANLINES = 0,
    SLUICE_EXR_STORAGE_TILES = 1, ///< Level 0 only.
    SLUICE_EXR_STORAGE_MIP_TILES = 2,
    SLUICE_EXR_STORAGE_RIP_TILES = 3
} SluiceExrStorage;

/** Properties of a file, and the memory that reading it takes. */
typedef struct SluiceExrInfo {
    uint32_t structSize; ///< sizeof(SluiceExrInfo).
    SluiceExrStorage storage;
    uint32_t chunkWidth, chunkHeight; ///< Texels of a tile or of a block of scanlines.
    const char *pCompression;         ///< "NONE", "ZIP" and so on.
    const char *pChannels;            ///< Names, separated by ", "; truncated if there are many.
    /** Bytes of the mip levels built at the first read. 0 if the file has levels. */
    uint64_t chainSize;
    /** Most bytes that a read uses temporarily, per reading thread. */
    uint64_t readSize;
    bool hasChromaticities;  ///< The file names its primaries; otherwise they are Rec. 709's.
    bool convertsPrimaries;  ///< The source converts R, G and B to Rec. 709.
    bool foreignPrimaries;   ///< R, G and B are returned in primaries other than Rec. 709's.
    float chromaticities[8]; ///< CIE x and y of red, green, blue and white.
} SluiceExrInfo;

/**
 * Describes the file of a source from sluiceCreateExrImageSource, without reading texels. The
 * strings live as long as the source.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for other sources.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetExrInfo(SluiceImageSource *source, SluiceExrInfo *pInfo);

/** Settings of a file to write. A field of zero selects its default. */
typedef struct SluiceExrWriteInfo {
    uint32_t structSize;  ///< sizeof(SluiceExrWriteInfo).
    const char *pPath;    ///< Required. The file is complete or absent.
    uint32_t tileWidth;   ///< Texels. Default: 128.
    uint32_t tileHeight;  ///< Texels. Default: 128.
    uint32_t threadCount; ///< Default: 1.
    bool uncompressed;    ///< Default: ZIP compression.
    bool opaque;          ///< Do not write A.
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log;
    void *pUserData;
    /** Reports progress, on one thread at a time. Return false to stop with
     *  SLUICE_ERROR_CANCELED. May be NULL. */
    bool (*pfnProgress)(void *pUserData, uint64_t doneTexels, uint64_t totalTexels);
} SluiceExrWriteInfo;

/**
 * Writes all levels of a source as a tiled, mip-mapped file (ROUND_DOWN) with half channels.
 *
 * Sources of one channel become Y, of two R and G, of four R, G, B and A. sRGB sources become
 * linear. Half sources keep their bits; other values are rounded to nearest and saturate at
 * +-65504.
 *
 * Tiles are made on threadCount threads, including the caller's, and written in order. The
 * allocator is called from all of them. Memory: a few tiles per thread, and 8 bytes per tile of the
 * file. The file is written as `pPath` + ".sluice-part", then synced to disk and renamed. A
 * .sluice-part file left by a killed process is overwritten.
 *
 * Returns SLUICE_NOT_READY, with nothing written, if no file descriptor is free. Close files and
 * call again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for tiles of more than 2^24
 *         texels and sources without a full chain; SLUICE_ERROR_UNSUPPORTED for more than 2^20
 *         texels in width or height; SLUICE_ERROR_LIMIT_EXCEEDED for more than 2^31 tiles;
 *         SLUICE_ERROR_BUSY if another writer has the file open; SLUICE_ERROR_IO, also if `pPath`
 *         is a link, a read-only file or not a regular file (it is kept);
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_CANCELED; any result but success of the
 *         source, SLUICE_NOT_READY included. No file is left after an error.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceWriteExrFile(const SluiceExrWriteInfo *pInfo,
                                           SluiceImageSource *source);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_EXR_H */
