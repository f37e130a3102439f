/**
 * Image sources: the interface through which Sluice reads texels.
 *
 * Implementations: OpenEXR (exr.h), DDS (dds.h), KTX2 (ktx2.h), tile stores (store.h), procedural
 * images, memory and arrays (this header). Applications can add their own.
 *
 * A source is a mip chain of one texel format. Any thread can read any rectangle of it, and several
 * threads can read at the same time. A source knows nothing of tiles: the reader asks for the
 * rectangle that a tile covers.
 */
#ifndef SLUICE_IMAGE_H
#define SLUICE_IMAGE_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Texel formats, named as in Vulkan. In memory, words of 16 and 32 bits are in the host's byte
 * order, as Vulkan takes them. In files they are little endian.
 *
 * - No suffix: channels in memory order.
 * - PACK32: words of 32 bits. The channel named last is in the lowest bits.
 * - SRGB: sRGB-encoded color and linear alpha.
 * - UINT, SINT: integers, which are never filtered. Coarser levels hold texels of the finer ones.
 * - BLOCK: compressed blocks of 8 bytes (BC1, BC4, ETC2_R8G8B8, ETC2_R8G8B8A1, EAC_R11) or 16
 *   bytes (the others). Blocks are 4x4 texels unless the name says another size.
 */
typedef enum SluiceFormat {
    SLUICE_FORMAT_UNDEFINED = 0,
    SLUICE_FORMAT_R8_UNORM = 1,
    SLUICE_FORMAT_R8G8B8A8_UNORM = 2,
    SLUICE_FORMAT_R8G8B8A8_SRGB = 3,
    SLUICE_FORMAT_R16_SFLOAT = 4,
    SLUICE_FORMAT_R16G16_SFLOAT = 5,
    SLUICE_FORMAT_R16G16B16A16_SFLOAT = 6,
    SLUICE_FORMAT_R32_SFLOAT = 7,
    SLUICE_FORMAT_R32G32_SFLOAT = 8,
    SLUICE_FORMAT_R32G32B32A32_SFLOAT = 9,
    SLUICE_FORMAT_R8G8_UNORM = 10,
    SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32 = 11,
    SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32 = 12, ///< Unsigned; mantissas of 6, 6 and 5 bits.
    SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32 = 13,  ///< Unsigned; three channels share one exponent.
    SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK = 14,
    SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK = 15,
    SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK = 16, ///< Alpha is 0 or 1.
    SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK = 17,
    SLUICE_FORMAT_BC2_UNORM_BLOCK = 18,
    SLUICE_FORMAT_BC2_SRGB_BLOCK = 19,
    SLUICE_FORMAT_BC3_UNORM_BLOCK = 20,
    SLUICE_FORMAT_BC3_SRGB_BLOCK = 21,
    SLUICE_FORMAT_BC4_UNORM_BLOCK = 22, ///< R
    SLUICE_FORMAT_BC4_SNORM_BLOCK = 23,
    SLUICE_FORMAT_BC5_UNORM_BLOCK = 24, ///< R and G
    SLUICE_FORMAT_BC5_SNORM_BLOCK = 25,
    SLUICE_FORMAT_BC6H_UFLOAT_BLOCK = 26, ///< RGB
    SLUICE_FORMAT_BC6H_SFLOAT_BLOCK = 27,
    SLUICE_FORMAT_BC7_UNORM_BLOCK = 28,
    SLUICE_FORMAT_BC7_SRGB_BLOCK = 29,
    SLUICE_FORMAT_R16_UNORM = 30,
    SLUICE_FORMAT_R16G16_UNORM = 31,
    SLUICE_FORMAT_R16G16B16A16_UNORM = 32,
    SLUICE_FORMAT_ETC2_R8G8B8_UNORM_BLOCK = 33,
    SLUICE_FORMAT_ETC2_R8G8B8_SRGB_BLOCK = 34,
    SLUICE_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK = 35, ///< Alpha is 0 or 1.
    SLUICE_FORMAT_ETC2_R8G8B8A1_SRGB_BLOCK = 36,
    SLUICE_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK = 37,
    SLUICE_FORMAT_ETC2_R8G8B8A8_SRGB_BLOCK = 38,
    SLUICE_FORMAT_EAC_R11_UNORM_BLOCK = 39,
    SLUICE_FORMAT_EAC_R11_SNORM_BLOCK = 40,
    SLUICE_FORMAT_EAC_R11G11_UNORM_BLOCK = 41,
    SLUICE_FORMAT_EAC_R11G11_SNORM_BLOCK = 42,
    SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK = 43, ///< LDR
    SLUICE_FORMAT_ASTC_4x4_SRGB_BLOCK = 44,
    SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK = 45, ///< LDR, blocks of 8x8 texels
    SLUICE_FORMAT_ASTC_8x8_SRGB_BLOCK = 46,
    SLUICE_FORMAT_R8_SNORM = 47,
    SLUICE_FORMAT_R8G8_SNORM = 48,
    SLUICE_FORMAT_R8G8B8A8_SNORM = 49,
    SLUICE_FORMAT_R16_SNORM = 50,
    SLUICE_FORMAT_R16G16_SNORM = 51,
    SLUICE_FORMAT_R16G16B16A16_SNORM = 52,
    SLUICE_FORMAT_R8_UINT = 53,
    SLUICE_FORMAT_R8G8_UINT = 54,
    SLUICE_FORMAT_R8G8B8A8_UINT = 55,
    SLUICE_FORMAT_R16_UINT = 56,
    SLUICE_FORMAT_R16G16_UINT = 57,
    SLUICE_FORMAT_R16G16B16A16_UINT = 58,
    SLUICE_FORMAT_R32_UINT = 59,
    SLUICE_FORMAT_R32G32_UINT = 60,
    SLUICE_FORMAT_R32G32B32A32_UINT = 61,
    SLUICE_FORMAT_R8_SINT = 62,
    SLUICE_FORMAT_R8G8_SINT = 63,
    SLUICE_FORMAT_R8G8B8A8_SINT = 64,
    SLUICE_FORMAT_R16_SINT = 65,
    SLUICE_FORMAT_R16G16_SINT = 66,
    SLUICE_FORMAT_R16G16B16A16_SINT = 67,
    SLUICE_FORMAT_R32_SINT = 68,
    SLUICE_FORMAT_R32G32_SINT = 69,
    SLUICE_FORMAT_R32G32B32A32_SINT = 70
} SluiceFormat;

/** Number of enumerators. Every format is below it. */
#define SLUICE_FORMAT_COUNT 71

/** Memory layout of a format: blocks of texels. Blocks of uncompressed formats are 1x1. */
typedef struct SluiceFormatInfo {
    uint32_t structSize;              ///< sizeof(SluiceFormatInfo).
    uint32_t blockSize;               ///< Bytes.
    uint32_t blockWidth, blockHeight; ///< Texels.
    uint32_t channelCount;            ///< 1 to 4. Missing G and B read as 0, missing A as 1.
    bool integer; ///< UINT or SINT: sampled with sample_integer.glsl, without filters.
} SluiceFormatInfo;

/**
 * Gets the block size and channel count of a format.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED if the format is UNDEFINED or
 *         unknown.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetFormatInfo(SluiceFormat format, SluiceFormatInfo *pInfo);
/**
 * Returns the bytes per texel. 0 for compressed formats, UNDEFINED and unknown values.
 * Thread safety: any thread.
 */
SLUICE_API uint32_t sluiceGetFormatTexelSize(SluiceFormat format);
/**
 * Returns the bytes of `width` x `height` texels with tightly packed rows. Partial blocks count as
 * whole blocks. A height of 1 gives the size of one row.
 *
 * UINT64_MAX if the size exceeds 64 bits. 0 for UNDEFINED and unknown values.
 * Thread safety: any thread.
 */
SLUICE_API uint64_t sluiceGetFormatRegionSize(SluiceFormat format, uint32_t width, uint32_t height);
/**
 * Returns the name without prefix, such as "R8_UNORM". "UNDEFINED" for UNDEFINED and unknown
 * values.
 * Thread safety: any thread.
 */
SLUICE_API const char *sluiceGetFormatName(SluiceFormat format);
/**
 * Gets width and height, in texels, of the standard 64 KiB tile.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_UNSUPPORTED if the format is UNDEFINED or
 *         unknown.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetStandardTileShape(SluiceFormat format, uint32_t *pWidth,
                                                   uint32_t *pHeight);

/** Address mode: VkSamplerAddressMode + 1, or 0 if unknown. */
typedef enum SluiceImageAddressMode {
    SLUICE_IMAGE_ADDRESS_MODE_UNKNOWN = 0, ///< Not recorded.
    SLUICE_IMAGE_ADDRESS_MODE_REPEAT = 1,
    SLUICE_IMAGE_ADDRESS_MODE_MIRRORED_REPEAT = 2,
    SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_EDGE = 3,
    SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_BORDER = 4,
    SLUICE_IMAGE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE = 5
} SluiceImageAddressMode;

/**
 * Description of an image source. A source must always return the same one.
 *
 * Arrays, streamer, demand loader and baker check every field and refuse values out of range.
 */
typedef struct SluiceImageInfo {
    uint32_t structSize;    ///< sizeof(SluiceImageInfo).
    uint32_t width, height; ///< Texels of level 0, 1 to 2^20. Level l has max(1, size >> l).
    /**
     * 1 to floor(log2(max(width, height))) + 1, the full chain. Streamers require levels down to
     * one that fits into a standard tile of 64 KiB. Demand loaders require levels down to one of at
     * most half a tile in both directions; beyond the last level they show its mean color.
     * sluiceCreateCompleteChainSource adds missing levels of uncompressed formats.
     * The baker accepts the full chain and, for uncompressed formats, 1 (only level 0).
     */
    uint32_t mipLevelCount;
    SluiceFormat format;      ///< Not UNDEFINED.
    const char *pName;        ///< For messages. May be NULL. Lives as long as the source.
    uint32_t arrayLayerCount; ///< At most 2^16. Default: 1.
    /** Address modes that the mip levels were filtered with. Sample with the same modes. Tile
     * stores record them. */
    SluiceImageAddressMode addressModeU, addressModeV;
    /** The layers are faces of cube maps: six for each cube, in the order +X, -X, +Y, -Y, +Z, -Z,
     *  as in Vulkan. Faces are square. Default: false. */
    bool cube;
} SluiceImageInfo;

/**
 * Rectangle of texels of one level and layer. It is not empty and does not leave the level.
 *
 * In compressed formats, x, y, width and height are multiples of the block size. Exception: width
 * and height of a region that ends at the right or lower edge of the level. Never grows.
 */
typedef struct SluiceImageRegion {
    uint32_t mipLevel;
    uint32_t x, y, width, height;
    uint32_t arrayLayer;
} SluiceImageRegion;

typedef struct SluiceImageSource SluiceImageSource;

/** Names one read that a source was asked to start. Copy it. Values are never used again while the
 *  reader exists. Never grows. */
typedef struct SluiceImageReadToken {
    void *pReader; ///< Belongs to Sluice, as the other fields.
    uint64_t ticket;
    uint32_t region, attempt;
} SluiceImageReadToken;

/** File offset of a failure whose position is unknown, or of data that is not in a file. */
#define SLUICE_UNKNOWN_OFFSET UINT64_MAX

/** Position of a failed read. Never grows. */
typedef struct SluiceImageFault {
    const char *pName; ///< Name of the source, or of the array's layer. "" if unknown.
    uint64_t offset;   ///< Bytes from the start of the file, or SLUICE_UNKNOWN_OFFSET.
} SluiceImageFault;

/**
 * Functions of an implementation. pfnGetInfo and pfnDestroy are required, and one of
 * pfnReadRegion and pfnReadRegionLocated.
 */
typedef struct SluiceImageSourceInterface {
    uint32_t structSize; ///< sizeof(SluiceImageSourceInterface).
    /**
     * Describes the image, and opens it first if necessary. On entry `*pInfo` is 0 except its
     * structSize. Thread safety: any thread.
     */
    SluiceResult (*pfnGetInfo)(SluiceImageSource *source, SluiceImageInfo *pInfo);
    /**
     * Fills `pTexels` with the rows of a region, `rowPitch` bytes apart. Rows of compressed formats
     * are rows of whole blocks, including blocks that the level's edge cuts. Sluice has checked
     * the region.
     *
     * May return SLUICE_NOT_READY or any error; `pTexels` is undefined then.
     * Thread safety: any thread, several calls at the same time.
     */
    SluiceResult (*pfnReadRegion)(SluiceImageSource *source, const SluiceImageRegion *pRegion,
                                  void *pTexels, size_t rowPitch);
    /** Destroys the source. No other call on it is in progress. */
    void (*pfnDestroy)(SluiceImageSource *source);
    /**
     * Like pfnReadRegion, and sets `*pFault` if it fails. May be NULL. If set, Sluice calls it
     * instead of pfnReadRegion. On entry `*pFault` holds the name from pfnGetInfo and
     * SLUICE_UNKNOWN_OFFSET.
     */
    SluiceResult (*pfnReadRegionLocated)(SluiceImageSource *source,
                                         const SluiceImageRegion *pRegion, void *pTexels,
                                         size_t rowPitch, SluiceImageFault *pFault);
    /**
     * Writes a number that stands for the texels of a region, and returns true. Two regions of
     * the source with the same number, width and height have equal texels. In paged mode and
     * demand loading such tiles share a page: one that comes while another one is resident is not
     * read. May be NULL.
     *
     * Returns false if the source knows of no equal region, or if the region's texels may change.
     * The answer for a region must never change, also after sluiceInvalidateDemandTexture: that
     * call drops the tiles of one texture, and other textures of the source keep theirs.
     * In a source of sluiceCreateArrayImageSource only numbers below 2^48 count.
     *
     * Must not wait and must not read files: a frame asks several times for each tile.
     *
     * Thread safety: any thread, several calls at the same time.
     */
    bool (*pfnIdentifyRegion)(SluiceImageSource *source, const SluiceImageRegion *pRegion,
                              uint64_t *pIdentity);
    /**
     * Starts an asynchronous read, for sources that would block a thread or answer
     * SLUICE_NOT_READY. May be NULL. If set, loaders, and so streamers and demand loaders, call it
     * instead of pfnReadRegion. Others still call pfnReadRegion, which is required.
     *
     * After SLUICE_SUCCESS the source fills `pTexels` as pfnReadRegion does, and then calls
     * sluiceCompleteImageRead with the token, once, on any thread. It may do so before this call
     * returns. `pTexels` stays writable until then, and the region is copied by the source. Rows
     * may lie in memory that the host reads slowly: write in order, and read nothing back.
     *
     * After any other result the token means nothing. SLUICE_ERROR_UNSUPPORTED makes the reader
     * call pfnReadRegion for this region. Other errors end the attempt, as in pfnReadRegion.
     *
     * A started read occupies no thread and does not count for maxReadsPerSource. Its bytes count
     * for maxBytesInFlight.
     *
     * Thread safety: any thread, several calls at the same time. No lock of Sluice is held.
     */
    SluiceResult (*pfnStartRead)(SluiceImageSource *source, const SluiceImageRegion *pRegion,
                                 void *pTexels, size_t rowPitch,
                                 const SluiceImageReadToken *pToken);
    /**
     * Tells the source that a started read is not needed. May be NULL. The source must still
     * complete the read, before or after this call returns, for example with SLUICE_ERROR_CANCELED.
     * May be called for a read that was just completed: ignore unknown tokens.
     *
     * Thread safety: any thread, after pfnStartRead has returned. No lock of Sluice is held.
     */
    void (*pfnCancelRead)(SluiceImageSource *source, const SluiceImageRegion *pRegion,
                          const SluiceImageReadToken *pToken);
} SluiceImageSourceInterface;

/** Base of every source: the first member of the implementation's struct. */
struct SluiceImageSource {
    const SluiceImageSourceInterface *pInterface;
};

/**
 * Gets the description of a source. The values are returned unchecked.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also for a source without an interface; errors of the source.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetImageInfo(SluiceImageSource *source, SluiceImageInfo *pInfo);

/**
 * Reads a rectangle of texels into `pTexels`.
 *
 * `rowPitch` is the distance in bytes between rows of texels; in compressed formats, between rows
 * of blocks. `pTexels` is undefined after an error.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if the region is empty, leaves
 *         its level or cuts a block, or if `rowPitch` is smaller than a row; errors of the source.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceReadImageRegion(SluiceImageSource *source,
                                              const SluiceImageRegion *pRegion, void *pTexels,
                                              size_t rowPitch);

/**
 * Reads a rectangle like sluiceReadImageRegion, and writes the position of a failure to `*pFault`.
 *
 * Tile stores, DDS and KTX2 files report the offset. A source that wraps other sources passes
 * `pFault` on to them. `pFault->pName` lives as long as the source.
 *
 * Errors, thread safety: as sluiceReadImageRegion.
 */
SLUICE_API SluiceResult sluiceReadImageRegionLocated(SluiceImageSource *source,
                                                     const SluiceImageRegion *pRegion,
                                                     void *pTexels, size_t rowPitch,
                                                     SluiceImageFault *pFault);

/**
 * Completes a read of pfnStartRead with any result.
 *
 * The reader may collect the read as soon as this call begins: do not write texels any more. A read
 * of several regions ends when all started ones are completed. Temporary results are retried as
 * loader.h says. Callbacks of the loader for failures and ends run in this call.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with nothing changed, if the
 *         read was completed before. The loader must exist: its destruction waits for all started
 *         reads.
 * Thread safety: any thread. Hold no lock that pfnStartRead, pfnCancelRead or a callback of the
 *         loader takes.
 */
SLUICE_API SluiceResult sluiceCompleteImageRead(const SluiceImageReadToken *pToken,
                                                SluiceResult result);

/**
 * Destroys a source. NULL is allowed. No call on the source may be in progress.
 * Thread safety: external on `source`.
 */
SLUICE_API void sluiceDestroyImageSource(SluiceImageSource *source);

/**
 * Function that computes the texels of a procedural image. Called on any thread, several at the
 * same time. Never grows.
 */
typedef struct SluiceProceduralImage {
    void *pUserData;
    /** Writes the linear RGBA color of texel (x, y) of `mipLevel`, which has width x height texels.
     */
    void (*pfnTexel)(void *pUserData, uint32_t mipLevel, uint32_t x, uint32_t y, uint32_t width,
                     uint32_t height, float rgba[4]);
} SluiceProceduralImage;

/**
 * Creates a source whose texels are computed when they are read.
 *
 * `pInfo->pName` is copied. A mipLevelCount of 0 means the full chain. Colors are converted to the
 * format like those of OpenEXR files (exr.h):
 * - Half floats saturate. UNORM and SNORM formats clamp and round. sRGB formats encode.
 * - NaN becomes 0, except in 32-bit float formats.
 * - Unsigned float formats round to nearest, ties to even, and saturate. E5B9G9R9 rounds ties up,
 *   as its specification says. Negative values become 0.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT; SLUICE_ERROR_UNSUPPORTED for
 *         arrays and compressed formats (use dds.h, ktx2.h or your own source);
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 * Source of E5B9G9R9: Vulkan specification, "RGB to Shared Exponent Conversion".
 */
SLUICE_API SluiceResult sluiceCreateProceduralImageSource(
    const SluiceProceduralImage *pImage, const SluiceImageInfo *pInfo,
    const SluiceAllocationCallbacks *pAllocator, SluiceImageSource **pSource);

/**
 * Creates a source from texels in memory, and builds its coarser levels once, by a box filter.
 *
 * `pTexels` is level 0: [height][width] of pInfo->format, tightly packed. It is copied. Each texel
 * of a coarser level is the mean of the area that it covers in the next finer level. sRGB formats
 * are filtered in linear light. NaN counts as 0. Integer formats are not filtered: a texel is one
 * near the center of that area.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT; SLUICE_ERROR_UNSUPPORTED for
 *         compressed formats and arrays; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateMemoryImageSource(const void *pTexels,
                                                      const SluiceImageInfo *pInfo,
                                                      const SluiceAllocationCallbacks *pAllocator,
                                                      SluiceImageSource **pSource);

/** Default of SluiceCompleteChainSourceCreateInfo.maxMemorySize: 512 MiB. */
#define SLUICE_COMPLETE_CHAIN_DEFAULT_MEMORY_SIZE ((uint64_t)1 << 29)

/** Settings of a source that completes a mip chain. A field of zero selects its default. */
typedef struct SluiceCompleteChainSourceCreateInfo {
    uint32_t structSize;       ///< sizeof(SluiceCompleteChainSourceCreateInfo).
    SluiceImageSource *source; ///< Required. Must outlive the new source.
    /**
     * Most bytes of built levels that are kept. The finest levels that do not fit are filtered at
     * each read, from four times as many texels of the next finer level. Default:
     * SLUICE_COMPLETE_CHAIN_DEFAULT_MEMORY_SIZE.
     */
    uint64_t maxMemorySize;
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;                       ///< Refused chains.
} SluiceCompleteChainSourceCreateInfo;

/**
 * Creates a source that has all mip levels, from one that lacks coarse ones.
 *
 * Levels that `source` has are read from `source`. The others are built from its last level by the
 * box filter of sluiceCreateMemoryImageSource. The first read of a built level builds all levels
 * that are kept; other readers wait. A read of a level that is not kept allocates about 2 MiB for
 * each level between it and the last level of `source`, and frees them before it returns.
 *
 * The first call on the new source asks `source` for its info. Calls return
 * SLUICE_ERROR_UNSUPPORTED if `source` lacks levels of a block-compressed format, and
 * SLUICE_ERROR_INVALID_ARGUMENT if its info is out of range. A read that fails returns the error of
 * `source`, with its fault; the next read tries again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateCompleteChainSource(
    const SluiceCompleteChainSourceCreateInfo *pInfo, SluiceImageSource **pSource);

/**
 * Creates an array source from `layerCount` sources of the same size, format and level count.
 *
 * The layers must outlive the array. Each layer has one array layer itself.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for 0 or more than 2^16 layers,
 *         layers that differ, or infos out of range; errors of the layers;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateArrayImageSource(SluiceImageSource *const *ppLayers,
                                                     uint32_t layerCount,
                                                     const SluiceAllocationCallbacks *pAllocator,
                                                     SluiceImageSource **pSource);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_IMAGE_H */
