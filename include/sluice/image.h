/**
 * Where texels come from: one interface, many implementations (OpenEXR in exr.h, DDS in dds.h, KTX2
 * in ktx2.h, procedural and wrapping ones here, the application's own).
 *
 * A source is a mip chain of one texel format that can be read rectangle by rectangle, from any
 * thread, several at once. It knows nothing of tiles: the reader asks for the rectangle that a tile
 * covers.
 */
#ifndef SLUICE_IMAGE_H
#define SLUICE_IMAGE_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Texel formats, named as Vulkan's. Without a suffix, channels in memory order; PACK32 ones are
 * little words of 32 bits, the last channel named in the lowest bits. sRGB ones hold encoded colour
 * and linear alpha. BLOCK ones are compressed: 4x4 texels in 8 bytes (BC1, BC4) or 16 (others).
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
    SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32 = 12, ///< no sign; 6, 6 and 5 bits of mantissa
    SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32 = 13,  ///< no sign; one exponent for three channels
    SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK = 14,
    SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK = 15,
    SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK = 16, ///< alpha 0 or 1
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
    SLUICE_FORMAT_BC7_SRGB_BLOCK = 29
} SluiceFormat;

/** The number of enumerators: formats are below it. */
#define SLUICE_FORMAT_COUNT 30

/** How texels lie in memory: in blocks, of one texel each where the format is not compressed. */
typedef struct SluiceFormatInfo {
    uint32_t blockSize;               ///< bytes
    uint32_t blockWidth, blockHeight; ///< texels
    uint32_t channelCount;            ///< 1 to 4; missing G and B read as 0, missing A as 1
} SluiceFormatInfo;

/** Errors: NULL_POINTER; UNSUPPORTED for UNDEFINED and unknown values. Any thread. */
SLUICE_API SluiceResult sluiceGetFormatInfo(SluiceFormat format, SluiceFormatInfo *pInfo);
/** Bytes per texel; 0 for UNDEFINED, unknown values and compressed formats. Any thread. */
SLUICE_API uint32_t sluiceFormatTexelSize(SluiceFormat format);
/** Bytes of `width` x `height` texels, cut blocks counting as whole ones, rows tightly packed;
 *  UINT64_MAX beyond 64 bits, 0 for UNDEFINED and unknown values. With a height of 1: a row. Any
 *  thread. */
SLUICE_API uint64_t sluiceFormatRegionSize(SluiceFormat format, uint32_t width, uint32_t height);
/** "R8_UNORM" and so on, "UNDEFINED" for others. Any thread. */
SLUICE_API const char *sluiceFormatString(SluiceFormat format);
/** Width and height in texels of the standard 64 KiB tile. Errors: UNSUPPORTED. Any thread. */
SLUICE_API SluiceResult sluiceGetStandardTileShape(SluiceFormat format, uint32_t *pWidth,
                                                   uint32_t *pHeight);

typedef struct SluiceImageInfo {
    uint32_t width, height; ///< texels of level 0; level l has max(1, size >> l)
    uint32_t mipLevelCount; ///< the full chain: floor(log2(max(width, height))) + 1
    SluiceFormat format;
    const char *pName;        ///< for messages; lives as long as the source
    uint32_t arrayLayerCount; ///< images of the same size and format in one; 0: 1
} SluiceImageInfo;

/**
 * Texels of one level; inside it and not empty. In compressed formats it consists of whole blocks:
 * x and y are multiples of the block's extent, and so are width and height, unless the region
 * reaches the right or lower edge of the level, where the last block may be cut.
 */
typedef struct SluiceImageRegion {
    uint32_t mipLevel;
    uint32_t x, y, width, height;
    uint32_t arrayLayer;
} SluiceImageRegion;

typedef struct SluiceImageSource SluiceImageSource;

/** The offset of what has none, or where nobody knows it. */
#define SLUICE_UNKNOWN_OFFSET UINT64_MAX

/** Where a read failed. */
typedef struct SluiceImageFault {
    const char *pName; ///< the source's, of an array the layer's; "" if it did not even tell that
    uint64_t offset;   ///< bytes from the beginning of that file; or SLUICE_UNKNOWN_OFFSET
} SluiceImageFault;

/** What an implementation offers. Of the two ways to read one is enough; all else is required. */
typedef struct SluiceImageSourceInterface {
    /** Opens the image if need be. Any thread. */
    SluiceResult (*pfnGetInfo)(SluiceImageSource *source, SluiceImageInfo *pInfo);
    /**
     * Fills `pTexels`: region.height rows of region.width texels, `rowPitch` bytes apart; in
     * compressed formats rows of blocks, cut ones given whole. The region has been checked. May
     * answer SLUICE_NOT_READY or any error; then the contents of `pTexels` are undefined. Any
     * thread, several at once.
     */
    SluiceResult (*pfnReadRegion)(SluiceImageSource *source, const SluiceImageRegion *pRegion,
                                  void *pTexels, size_t rowPitch);
    /** No call is under way. */
    void (*pfnDestroy)(SluiceImageSource *source);
    /**
     * NULL, or takes the place of pfnReadRegion: after an error `*pFault` is where. Before, it is
     * the name that pfnGetInfo tells, and SLUICE_UNKNOWN_OFFSET.
     */
    SluiceResult (*pfnReadRegionLocated)(SluiceImageSource *source,
                                         const SluiceImageRegion *pRegion, void *pTexels,
                                         size_t rowPitch, SluiceImageFault *pFault);
} SluiceImageSourceInterface;

/** The first member of every implementation's own struct. */
struct SluiceImageSource {
    const SluiceImageSourceInterface *pInterface;
};

/** Errors: NULL_POINTER, and what the implementation says. Any thread. */
SLUICE_API SluiceResult sluiceGetImageInfo(SluiceImageSource *source, SluiceImageInfo *pInfo);

/**
 * Reads a rectangle. `rowPitch`: bytes from one row of texels to the next, in compressed formats
 * from one row of blocks. Errors: NULL_POINTER; INVALID_ARGUMENT if the region leaves its level, is
 * empty or cuts a block, or rowPitch is below a row's size; and what the implementation says. Any
 * thread.
 */
SLUICE_API SluiceResult sluiceReadImageRegion(SluiceImageSource *source,
                                              const SluiceImageRegion *pRegion, void *pTexels,
                                              size_t rowPitch);

/**
 * The same, and after an error `*pFault` is where: tile stores, DDS and KTX2 files know the offset.
 * A source that wraps others passes them `pFault`. Its name lives as long as the source.
 */
SLUICE_API SluiceResult sluiceReadImageRegionLocated(SluiceImageSource *source,
                                                     const SluiceImageRegion *pRegion,
                                                     void *pTexels, size_t rowPitch,
                                                     SluiceImageFault *pFault);

/** NULL is allowed. No call may be under way. */
SLUICE_API void sluiceDestroyImageSource(SluiceImageSource *source);

/** Colours of a procedural image; linear RGBA. Called from any thread, several at once. */
typedef struct SluiceProceduralImage {
    void *pUserData;
    /** Writes the colour of the texel (x, y) of `mipLevel`, whose size is width x height. */
    void (*pfnTexel)(void *pUserData, uint32_t mipLevel, uint32_t x, uint32_t y, uint32_t width,
                     uint32_t height, float rgba[4]);
} SluiceProceduralImage;

/**
 * An image that is computed where it is read. `pInfo->pName` is copied, mipLevelCount may be 0 for
 * the full chain. Colours are converted as exr.h says of files: half saturates, 8 and 10 bits clamp
 * and round, sRGB encodes, NaN becomes 0 but in 32-bit float formats. Formats without a sign round
 * to the nearest value that they have, ties to even (E5B9G9R9: up, as its specification says),
 * saturate, and make 0 of what is negative. Errors: NULL_POINTER, INVALID_ARGUMENT; UNSUPPORTED for
 * compressed formats, which come from dds.h, ktx2.h or an own source, and for arrays;
 * OUT_OF_HOST_MEMORY. Any thread.
 * Source of E5B9G9R9: Vulkan specification, "RGB to Shared Exponent Conversion".
 */
SLUICE_API SluiceResult sluiceCreateProceduralImageSource(
    const SluiceProceduralImage *pImage, const SluiceImageInfo *pInfo,
    const SluiceAllocationCallbacks *pAllocator, SluiceImageSource **pSource);

/**
 * Texels in memory, level 0 given, the other levels made by a box filter once (in linear light for
 * sRGB), each texel the mean of the area it covers in the level above, NaN counting as 0. `pTexels`
 * is [height][width] of pInfo->format, tightly packed, and is copied. Errors: NULL_POINTER,
 * INVALID_ARGUMENT; UNSUPPORTED for compressed formats and arrays; OUT_OF_HOST_MEMORY. Any thread.
 */
SLUICE_API SluiceResult sluiceCreateMemoryImageSource(const void *pTexels,
                                                      const SluiceImageInfo *pInfo,
                                                      const SluiceAllocationCallbacks *pAllocator,
                                                      SluiceImageSource **pSource);

/**
 * An array whose layers are `layerCount` sources of one size and format. They must outlive it and
 * have one layer each. Errors: NULL_POINTER; INVALID_ARGUMENT for no layers or layers that differ;
 * what the sources say; OUT_OF_HOST_MEMORY. Any thread.
 */
SLUICE_API SluiceResult sluiceCreateArrayImageSource(SluiceImageSource *const *ppLayers,
                                                     uint32_t layerCount,
                                                     const SluiceAllocationCallbacks *pAllocator,
                                                     SluiceImageSource **pSource);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_IMAGE_H */
