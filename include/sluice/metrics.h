/** Metrics of the difference between two pictures: PSNR, SSIM, FLIP. */
#ifndef SLUICE_METRICS_H
#define SLUICE_METRICS_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Computes the peak signal-to-noise ratio of two 8-bit pictures, in dB, over all channels. Peak:
 * 255. +infinity if the pictures are equal.
 *
 * Both pictures are [height][width][channelCount], tightly packed. Sums are exact integers, so the
 * result does not depend on the order of summation.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if a size is 0 or `channelCount`
 *         is above 4.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceComputePsnr8(const uint8_t *pA, const uint8_t *pB, uint32_t width,
                                           uint32_t height, uint32_t channelCount, double *pPsnr);

/** Pixel formats in memory. Alpha is ignored. Floats need no alignment. */
typedef enum SluicePixelFormat {
    SLUICE_PIXEL_FORMAT_RGBA8_SRGB = 0,   ///< Four bytes; R, G and B encoded as sRGB.
    SLUICE_PIXEL_FORMAT_RGBA32_FLOAT = 1, ///< Four floats; linear light, sRGB primaries.
    SLUICE_PIXEL_FORMAT_R32_FLOAT = 2     ///< One float; linear gray.
} SluicePixelFormat;

/**
 * Two pictures to compare: [height][width] of one format. They are only read.
 *
 * Floats are clamped to [0, peak], as on a display whose white is `peak`: infinities become the
 * peak or 0, and NaN becomes 0. If NaN matters, check for it beforehand.
 */
typedef struct SluicePicturePair {
    uint32_t structSize; ///< sizeof(SluicePicturePair).
    const void *pA, *pB;
    size_t rowPitchA, rowPitchB; ///< Bytes between rows. Default: tightly packed.
    uint32_t width, height;      ///< Pixels, at least 1.
    SluicePixelFormat format;
    float peak; ///< Finite and above 0. Ignored for RGBA8_SRGB.
} SluicePicturePair;

/** Destination of one value per pixel: [height][width], the size of the pictures. Never grows. */
typedef struct SluiceMetricMap {
    float *pValues;
    size_t rowPitch; ///< Bytes between rows, a multiple of 4. Default: tightly packed.
} SluiceMetricMap;

/**
 * Computes the structural similarity (SSIM): mean in [-1, 1], 1 if the pictures are equal.
 * Symmetric.
 *
 * It compares one channel. RGBA8_SRGB: luma with the weights of BT.709, of encoded values, peak
 * 255. RGBA32_FLOAT: luma of the values. R32_FLOAT: the values. Windows are Gaussian, 11x11, sigma
 * 1.5, weights summing to 1; K1 = 0.01, K2 = 0.03. Variances are weighted means without bias
 * correction.
 *
 * The mean covers all pixels whose window lies inside the picture. Along an axis shorter than 11,
 * where no window fits, it covers all positions. A window that crosses the border is cut and its
 * weights are normalized again. `pMap` gets a value for every pixel. `pMap` may be NULL.
 *
 * Memory: about 500 bytes per column, whatever the height. A NULL `pAllocator` means malloc and
 * free. After an error `*pMean` and the map are unchanged.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a size of 0, an unknown
 *         format, a peak out of range, a pitch below the size of a row, or a picture larger than
 *         the address space; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 * Source: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to
 * Structural Similarity", 2004.
 */
SLUICE_API SluiceResult sluiceComputeSsim(const SluicePicturePair *pPair,
                                          const SluiceMetricMap *pMap,
                                          const SluiceAllocationCallbacks *pAllocator,
                                          double *pMean);

/**
 * Computes LDR-FLIP, the difference seen when the pictures alternate in place: mean in [0, 1], 0 if
 * the pictures are equal. Symmetric. Black and white differ by 0.967, blue and green by 1.
 *
 * `pixelsPerDegree` of visual angle is distance * pixels / width * pi / 180, with the viewing
 * distance and the display's width in meters. Range: 1 to 4096. Default for 0: the paper's 67.02 (a
 * display 0.7 m wide with 3840 pixels, seen from 0.7 m).
 *
 * Floats are divided by the peak. HDR-FLIP, which compares several exposures, is not provided.
 * Beyond the border the border's pixels are repeated. `pMap` gets the error of each pixel and may
 * be NULL. `*pMean` is the mean of those errors.
 *
 * Memory: about 120 bytes per column for each row of the filters (21 rows at 67.02). A NULL
 * `pAllocator` means malloc and free.
 *
 * Errors, state after an error: as sluiceComputeSsim; SLUICE_ERROR_INVALID_ARGUMENT also if
 *         `pixelsPerDegree` is out of range.
 * Thread safety: any thread.
 * Source: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference
 * Evaluator for Alternating Images", 2020.
 */
SLUICE_API SluiceResult sluiceComputeFlip(const SluicePicturePair *pPair, float pixelsPerDegree,
                                          const SluiceMetricMap *pMap,
                                          const SluiceAllocationCallbacks *pAllocator,
                                          double *pMean);

/**
 * Converts values in [0, 1] to colors from black through purple and orange to pale yellow.
 *
 * The colors interpolate linearly between nine samples of the color map "magma". Values are
 * clamped; NaN counts as 0. `pColors` is [count][4], RGBA8 sRGB, alpha 255.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, unless `count` is 0.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceColorMagma(const float *pValues, size_t count, uint8_t *pColors);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_METRICS_H */
