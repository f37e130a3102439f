/**
 * Bakes pictures into tile stores (store.h). Link `sluice-bake`.
 *
 * Reads any file that libvips or OpenEXR reads, including files larger than memory, and filters the
 * mip levels. A picture is read once, from top to bottom. Each level keeps the rows of one or two
 * tiles and the rows that the filter reaches, so memory grows only with the picture's width.
 *
 * Levels are filtered in linear light: sRGB is decoded, colors are weighted by alpha, normals are
 * filtered as vectors. Each level is made from the next finer one at full precision. Sizes are
 * rounded down; where a size does not halve evenly, weights follow the area that a texel covers.
 */
#ifndef SLUICE_BAKE_H
#define SLUICE_BAKE_H

#include <sluice/image.h>
#include <sluice/input.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Default compression level of zstd. */
#define SLUICE_BAKE_DEFAULT_COMPRESSION 10u

/** Filter that makes a texel from the next finer level. */
typedef enum SluiceBakeFilter {
    SLUICE_BAKE_FILTER_BOX = 0,   ///< Mean of the area that the texel covers.
    SLUICE_BAKE_FILTER_KAISER = 1 ///< Sharper: Kaiser-windowed sinc, 6 texels, alpha 4. May ring.
} SluiceBakeFilter;

/** Texels beyond an edge, for filters that reach there. The box filter does not. */
typedef enum SluiceBakeWrap {
    SLUICE_BAKE_WRAP_CLAMP = 0,
    SLUICE_BAKE_WRAP_REPEAT = 1,
    SLUICE_BAKE_WRAP_MIRROR = 2
} SluiceBakeWrap;

/** Transfer function of R, G and B in the picture. */
typedef enum SluiceBakeTransfer {
    /** SRGB for integer pictures with two or more channels that are not normal maps; else LINEAR.
     */
    SLUICE_BAKE_TRANSFER_AUTO = 0,
    SLUICE_BAKE_TRANSFER_SRGB = 1,
    SLUICE_BAKE_TRANSFER_LINEAR = 2
} SluiceBakeTransfer;

/** Meaning of the picture's alpha. The store keeps the same meaning. */
typedef enum SluiceBakeAlpha {
    /** PREMULTIPLIED for OpenEXR files, sources and SNORM formats; else STRAIGHT. */
    SLUICE_BAKE_ALPHA_AUTO = 0,
    /**
     * Coverage, clamped to [0, 1], that colors are weighted by. Alpha 0 counts a little (2^-24), so
     * an uncovered texel is the mean of its colors. Filters with negative lobes fade colors to
     * black instead where the resulting alpha is below 1/1024.
     */
    SLUICE_BAKE_ALPHA_STRAIGHT = 1,
    /** Colors are premultiplied, or alpha is not coverage. Channels are filtered independently. */
    SLUICE_BAKE_ALPHA_PREMULTIPLIED = 2
} SluiceBakeAlpha;

/** Work that is spent on blocks of BC6H, BC7 and ASTC. Decisions 55 and 56 have figures. */
typedef enum SluiceBakeQuality {
    SLUICE_BAKE_QUALITY_NORMAL = 0,
    SLUICE_BAKE_QUALITY_FAST = 1,
    SLUICE_BAKE_QUALITY_BEST = 2
} SluiceBakeQuality;

/** Settings of one picture. A field of zero selects its default. */
typedef struct SluiceBakeSettings {
    uint32_t structSize; ///< sizeof(SluiceBakeSettings).
    /**
     * Format of the store: any but BC2, ETC2, EAC and the signed BC4 and BC5. Integer pictures
     * (UINT, SINT) support only their own format, and other pictures no integer format. `transfer`
     * selects between a format and its sRGB twin; you may name either. Formats without a twin hold
     * linear light.
     *
     * Default (UNDEFINED): the format that fits the picture.
     * - 8-bit integers: R8 for one channel; R8G8 for two that are not gray and alpha; else
     *   R8G8B8A8. Normal maps: R8G8B8A8 UNORM.
     * - 16-bit integers: R16, R16G16 or R16G16B16A16 UNORM, chosen like 8-bit formats. Colors
     *   become linear light.
     * - 16- and 32-bit floats: same type, one or four channels.
     * - SNORM, packed and integer formats (DDS, KTX2, sources): the picture's format.
     */
    SluiceFormat format;
    SluiceBakeQuality quality;   ///< Default: NORMAL.
    SluiceBakeTransfer transfer; ///< Default: AUTO.
    SluiceBakeAlpha alpha;       ///< Default: AUTO.
    SluiceBakeFilter filter;     ///< Default: BOX.
    SluiceBakeWrap wrapX, wrapY; ///< Recorded as address modes. Default: CLAMP.
    /**
     * R, G and B are unit vectors; UNORM formats hold (n + 1) / 2. Vectors of every level are
     * normalized. Vectors that cancel out become (0, 0, 1). For pictures of two channels z >= 0 is
     * computed.
     */
    bool normalMap;
    /**
     * Alpha threshold of a cut-out, above 0 and at most 1. Alpha of each level is scaled so that
     * the same share of texels reaches it as in the picture. The picture is read twice. Default: 0,
     * off.
     */
    float cutout;
    uint32_t
        compressionLevel; ///< Level of zstd, 1 to 22. Default: SLUICE_BAKE_DEFAULT_COMPRESSION.
    bool uncompressed;
    /**
     * Keep R, G and B of OpenEXR files as stored, ignoring `chromaticities`. The store's color
     * space is then UNDEFINED. Otherwise colors are converted to the primaries of Rec. 709, as
     * exr.h says, unless normalMap is set.
     */
    bool keepPrimaries;
} SluiceBakeSettings;

/** Settings of a baker. A field of zero selects its default. */
typedef struct SluiceBakerCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceBakerCreateInfo).
    uint32_t
        threadCount; ///< Threads that make tiles, including callers. Default: one per processor.
    /**
     * Most bytes for all pictures baked at the same time. Default: 2^30. A picture waits until
     * others have released enough. The memory for reading a file is an estimate, because libvips
     * allocates its own. Formats that libvips unpacks as a whole (interlaced PNG, progressive JPEG,
     * WebP, GIF, HEIF, JPEG XL) count at their full size.
     */
    uint64_t maxMemory;
    /**
     * Default: malloc and free. Called from all threads. libvips, OpenEXRCore, libsquish and
     * astcenc always use malloc.
     */
    const SluiceAllocationCallbacks *pAllocator;
    SluiceLogCallback log; ///< Problems of a file, with its name.
} SluiceBakerCreateInfo;

/** Threads and memory limit that bakes share. */
typedef struct SluiceBaker SluiceBaker;

/**
 * Creates a baker and starts its threads. Initializes libvips for the process and disables the
 * operation cache of libvips. While a baker exists, warnings of libvips (GLib's log domain VIPS)
 * come to Sluice. Warnings about a picture go to the baker's log, with its name. All others go to
 * GLib's default handler.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED if libvips does not start;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY, also if a thread cannot be started.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateBaker(const SluiceBakerCreateInfo *pInfo, SluiceBaker **pBaker);

/**
 * Destroys a baker. No call on it may be in progress. NULL is allowed.
 * Thread safety: external on `baker`.
 */
SLUICE_API void sluiceDestroyBaker(SluiceBaker *baker);

/** Input and output of one bake. A field of zero selects its default. */
typedef struct SluiceBakeInfo {
    uint32_t structSize; ///< sizeof(SluiceBakeInfo).
    /** Path of the picture. NULL: bake pInput or `source`. */
    const char *pInputPath;
    /** Source to bake if pInputPath and pInput are NULL: level 0 of all layers, or all levels
     *  unchanged if they are block-compressed or integers. Not owned. */
    SluiceImageSource *source;
    const char *pOutputPath;             ///< Required.
    const SluiceBakeSettings *pSettings; ///< Default: every setting has its default.
    /** Bake even if the output was made from this input with these settings. */
    bool force;
    void *pUserData;
    /** Reports progress on the caller's thread. Return false to stop with
     *  SLUICE_ERROR_CANCELED. Both numbers are 0 while the bake waits for memory. May be NULL. */
    bool (*pfnProgress)(void *pUserData, uint64_t doneTexels, uint64_t totalTexels);
    /**
     * Bakes these bytes instead of a file (input.h). All kinds of pictures can be baked so.
     * pInputPath is then a name for messages and may be NULL. The output is always baked anew.
     * Bytes of pfnRead are copied to memory first, unless they are OpenEXR, DDS or KTX2. Keep the
     * bytes until sluiceBakeFile returns. Default: NULL.
     */
    const SluiceInput *pInput;
    /**
     * First level to bake: a preview. It becomes level 0 of the store. The picture is shrunk while
     * it is read, so a JPEG file takes a small part of the time. Texels differ slightly from those
     * of the whole chain, because gamma is ignored. The output is always baked anew. Must be below
     * the number of levels. OpenEXR, DDS and KTX2 files and sources are refused with
     * SLUICE_ERROR_UNSUPPORTED unless this is 0. Default: 0, the whole chain.
     */
    uint32_t firstLevel;
    /**
     * Paths of pictures that become the layers of one store, in this order. pInputPath, pInput and
     * `source` must be NULL. The pictures must have the same size, and formats that become the same
     * format (`format` of the settings makes them so). All are opened before anything is written,
     * one at a time. Files of arrays give all their layers. Default: NULL.
     */
    const char *const *ppLayerPaths;
    uint32_t layerPathCount; ///< At most SLUICE_STORE_MAX_ARRAY_LAYERS. Default: 0.
    /**
     * The layers are faces of cube maps: square, six for each cube, in the order of
     * SluiceImageInfo.cube. Cube maps of DDS files, KTX2 files and sources need not set this.
     * Default: false.
     */
    bool cube;
} SluiceBakeInfo;

/** Result of one bake. */
typedef struct SluiceBakeReport {
    uint32_t structSize; ///< sizeof(SluiceBakeReport).
    bool skipped; ///< Output was up to date: same sizes, times and settings hash of the inputs.
    uint32_t width, height, mipLevelCount, arrayLayerCount;
    SluiceFormat format;
    uint64_t inputSize, outputSize; ///< Bytes of the files. inputSize: 0 for a source and pInput.
    uint64_t replacedTexelCount;    ///< Texels in one or more of the last three counts.
    uint64_t resumedTileCount;      ///< Tiles reused from an interrupted bake.
    uint64_t memorySize;            ///< Bytes reserved for this picture.
    uint64_t nanTexelCount;         ///< Texels with a NaN, which became 0.
    uint64_t infiniteTexelCount;    ///< Texels with an infinity, which became finite.
    uint64_t clampedTexelCount;     ///< Texels with a finite value out of range.
} SluiceBakeReport;

/**
 * Bakes one picture into one store.
 *
 * NaN becomes 0. Infinities become +-65504, or +-2^120 in stores of 32-bit floats, so that filters
 * in shaders stay finite. In stores of 32-bit floats finite values are kept and averaged without
 * overflow; in other stores they are clamped to +-65504.
 *
 * Level 0 is stored byte for byte if the format holds the picture's samples. Block-compressed
 * pictures (DDS, KTX2) keep all their levels and must have the full chain. Of the settings, only
 * these apply to them: transfer (selects the sRGB twin of the format or the reverse), normalMap,
 * wraps, compression. Integer pictures (UINT, SINT) keep their format and the levels that they
 * have. Texels of missing levels are picked from the next finer level. Of the settings, only wraps
 * and compression apply to them. SNORM pictures are averaged as signed numbers. ICC profiles are
 * not applied. CMYK, Lab and similar become sRGB. Pictures are turned as their EXIF orientation
 * says, with a message of SLUICE_LOG_INFO, and are then unpacked as a whole.
 *
 * The output is complete or absent. An interrupted bake leaves the output path + ".sluice-part";
 * the next bake resumes it. `pReport` may be NULL.
 *
 * Returns SLUICE_NOT_READY, with no store written, while the process has too few file descriptors
 * for the input. Finished tiles are kept for the next bake. Sluice leaves the last 16 descriptors
 * below the soft limit to others. Close files and bake again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for values out of range,
 *         including the source's info, if the output or its .sluice-part file is an input, also
 *         through links, if layers differ in size or format, and if faces of cube maps are not
 *         square or not six for each cube; SLUICE_ERROR_FILE_NOT_FOUND; SLUICE_ERROR_IO;
 * SLUICE_ERROR_BUSY if another writer has the output open; SLUICE_ERROR_CORRUPT_DATA for truncated
 * files and files that no reader understands; SLUICE_ERROR_UNSUPPORTED for more than four channels,
 *         complex numbers, formats that Sluice cannot encode, integer pictures with another
 *         `format`, and integer formats of other pictures; SLUICE_ERROR_LIMIT_EXCEEDED if
 *         maxMemory is too small for the picture; SLUICE_ERROR_CANCELED;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread, several calls at the same time, but only one per output.
 */
SLUICE_API SluiceResult sluiceBakeFile(SluiceBaker *baker, const SluiceBakeInfo *pInfo,
                                       SluiceBakeReport *pReport);

/**
 * Describes the store that sluiceBakeFile would write, without writing it: size, format, levels and
 * layers. Reads the header of the picture. pOutputPath is not used.
 *
 * Errors, thread safety: as sluiceBakeFile.
 */
SLUICE_API SluiceResult sluiceDescribeBake(SluiceBaker *baker, const SluiceBakeInfo *pInfo,
                                           SluiceBakeReport *pReport);

/**
 * Computes the hash of all settings that determine the texels, as recorded in stores.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceHashBakeSettings(const SluiceBakeSettings *pSettings,
                                               uint64_t *pHash);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_BAKE_H */
