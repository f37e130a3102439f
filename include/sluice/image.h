/**
 * Where texels come from: one interface, many implementations (OpenEXR in exr.h, procedural and
 * wrapping ones here, the application's own).
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

/** Texel formats; channels in memory order. sRGB ones hold encoded colour and linear alpha. */
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
    SLUICE_FORMAT_R32G32B32A32_SFLOAT = 9
} SluiceFormat;

/** Bytes per texel, 0 for UNDEFINED and unknown values. Any thread. */
SLUICE_API uint32_t sluiceFormatTexelSize(SluiceFormat format);
/** "R8_UNORM" and so on, "UNDEFINED" for others. Any thread. */
SLUICE_API const char *sluiceFormatString(SluiceFormat format);
/** Width and height in texels of the standard 64 KiB tile. Errors: UNSUPPORTED. Any thread. */
SLUICE_API SluiceResult sluiceGetStandardTileShape(SluiceFormat format, uint32_t *pWidth,
                                                   uint32_t *pHeight);

typedef struct SluiceImageInfo {
    uint32_t width, height; ///< texels of level 0; level l has max(1, size >> l)
    uint32_t mipLevelCount; ///< the full chain: floor(log2(max(width, height))) + 1
    SluiceFormat format;
    const char *pName; ///< for messages; lives as long as the source
} SluiceImageInfo;

/** Texels of one level; inside it and not empty. */
typedef struct SluiceImageRegion {
    uint32_t mipLevel;
    uint32_t x, y, width, height;
} SluiceImageRegion;

typedef struct SluiceImageSource SluiceImageSource;

/** What an implementation offers. Every function is required. */
typedef struct SluiceImageSourceInterface {
    /** Opens the image if need be. Any thread. */
    SluiceResult (*pfnGetInfo)(SluiceImageSource *source, SluiceImageInfo *pInfo);
    /**
     * Fills `pTexels`: region.height rows of region.width texels, `rowPitch` bytes apart. The
     * region has been checked. May answer SLUICE_NOT_READY or any error; then the contents of
     * `pTexels` are undefined. Any thread, several at once.
     */
    SluiceResult (*pfnReadRegion)(SluiceImageSource *source, const SluiceImageRegion *pRegion,
                                  void *pTexels, size_t rowPitch);
    /** No call is under way. */
    void (*pfnDestroy)(SluiceImageSource *source);
} SluiceImageSourceInterface;

/** The first member of every implementation's own struct. */
struct SluiceImageSource {
    const SluiceImageSourceInterface *pInterface;
};

/** Errors: NULL_POINTER, and what the implementation says. Any thread. */
SLUICE_API SluiceResult sluiceGetImageInfo(SluiceImageSource *source, SluiceImageInfo *pInfo);

/**
 * Reads a rectangle. Errors: NULL_POINTER; INVALID_ARGUMENT if the region leaves its level or is
 * empty or rowPitch is below a row's size; and what the implementation says. Any thread.
 */
SLUICE_API SluiceResult sluiceReadImageRegion(SluiceImageSource *source,
                                              const SluiceImageRegion *pRegion, void *pTexels,
                                              size_t rowPitch);

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
 * the full chain. Colours are converted as exr.h says of files: half saturates, 8 bits clamp and
 * round, sRGB encodes, NaN becomes 0 but in float formats. Errors: NULL_POINTER, INVALID_ARGUMENT,
 * OUT_OF_HOST_MEMORY. Any thread.
 */
SLUICE_API SluiceResult sluiceCreateProceduralImageSource(
    const SluiceProceduralImage *pImage, const SluiceImageInfo *pInfo,
    const SluiceAllocationCallbacks *pAllocator, SluiceImageSource **pSource);

/**
 * Texels in memory, level 0 given, the other levels made by a box filter once (in linear light for
 * sRGB), each texel the mean of the area it covers in the level above, NaN counting as 0. `pTexels`
 * is [height][width] of pInfo->format, tightly packed, and is copied. Errors: NULL_POINTER,
 * INVALID_ARGUMENT, OUT_OF_HOST_MEMORY. Any thread.
 */
SLUICE_API SluiceResult sluiceCreateMemoryImageSource(const void *pTexels,
                                                      const SluiceImageInfo *pInfo,
                                                      const SluiceAllocationCallbacks *pAllocator,
                                                      SluiceImageSource **pSource);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_IMAGE_H */
