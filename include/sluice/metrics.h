/** How far two pictures are apart. */
#ifndef SLUICE_METRICS_H
#define SLUICE_METRICS_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Peak signal-to-noise ratio in dB of two 8-bit pictures, over all `channelCount` channels, peak
 * 255; +infinity if they are equal. Both are [height][width][channelCount], tightly packed. Sums
 * are exact integers, so the order of summation does not matter.
 *
 * Errors: NULL_POINTER; INVALID_ARGUMENT if a size is 0 or channelCount is above 4. Any thread.
 */
SLUICE_API SluiceResult sluiceComputePsnr8(const uint8_t *pA, const uint8_t *pB, uint32_t width,
                                           uint32_t height, uint32_t channelCount, double *pPsnr);

/** What a pixel is in memory. Alpha is not looked at; floats need no alignment. */
typedef enum SluicePixelFormat {
    SLUICE_PIXEL_FORMAT_RGBA8_SRGB = 0,   ///< four bytes, R, G and B encoded as sRGB
    SLUICE_PIXEL_FORMAT_RGBA32_FLOAT = 1, ///< four floats, linear light of sRGB's primaries
    SLUICE_PIXEL_FORMAT_R32_FLOAT = 2     ///< a float, a linear grey
} SluicePixelFormat;

/**
 * Two pictures [height][width] of one format, and the two are read alone.
 *
 * Floats are clamped to [0, peak], so infinities are the peak or 0 and a NaN is 0: what a display
 * whose white is `peak` would show. Whoever wants a NaN to stand out looks for it beforehand.
 */
typedef struct SluicePicturePair {
    const void *pA, *pB;
    size_t rowPitchA, rowPitchB; ///< bytes from row to row; 0: tightly packed
    uint32_t width, height;      ///< pixels, at least 1
    SluicePixelFormat format;
    float peak; ///< of float formats, finite and above 0; in others it is not looked at
} SluicePicturePair;

/** Where a value per pixel goes: [height][width], as large as the pictures. */
typedef struct SluiceMetricMap {
    float *pValues;
    size_t rowPitch; ///< bytes from row to row, a multiple of 4; 0: tightly packed
} SluiceMetricMap;

/**
 * Structural similarity: mean in [-1, 1], 1 if the pictures are equal; symmetric.
 *
 * It is that of one channel: luma of BT.709's weights, of the encoded values in RGBA8_SRGB (peak
 * 255), of the values themselves in RGBA32_FLOAT, and the values in R32_FLOAT. Windows are
 * Gaussian, 11x11, sigma 1.5, weights summing to 1; K1 = 0.01, K2 = 0.03; variances are weighted
 * means, not corrected for bias. The mean is over all pixels whose window lies in the picture;
 * where an axis is shorter than 11 no window does, and all positions of that axis count. A window
 * that reaches beyond the border is cut and the rest of its weights made to sum to 1 again: so it
 * is in the map, which has a value for every pixel, and in small pictures. `pMap` may be NULL.
 *
 * Takes about 500 bytes of memory per column, whatever the height, from `pAllocator` (NULL: malloc
 * and free). Errors: NULL_POINTER; INVALID_ARGUMENT for a size of 0, an unknown format, a peak
 * outside its range, a pitch below a row's size or a picture beyond the address space;
 * OUT_OF_HOST_MEMORY. After an error `*pMean` and the map are as before. Any thread. Source: Wang,
 * Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
 * Similarity", 2004.
 */
SLUICE_API SluiceResult sluiceComputeSsim(const SluicePicturePair *pPair,
                                          const SluiceMetricMap *pMap,
                                          const SluiceAllocationCallbacks *pAllocator,
                                          double *pMean);

/**
 * LDR-FLIP, what one sees of the difference when the pictures alternate in place: mean in [0, 1], 0
 * if they are equal; symmetric. Black against white is 0.967, blue against green is 1.
 *
 * `pixelsPerDegree`, of visual angle, in [1, 4096]: distance * pixels / width * pi / 180, with the
 * distance to the display and its width in metres; 0 asks for the paper's 67.02 (a display of 0.7 m
 * and 3840 pixels seen from 0.7 m). Floats are divided by the peak; HDR-FLIP, which looks at
 * several exposures, is not here. Beyond the border the pixels of the border go on. `pMap`, which
 * may be NULL, gets the error of each pixel; `*pMean` is their mean.
 *
 * Takes about 120 bytes per column for each row of its filters (21 at 67.02) from `pAllocator`
 * (NULL: malloc and free). Errors and state after one as sluiceComputeSsim, and INVALID_ARGUMENT
 * for pixelsPerDegree outside its range. Any thread. Source: Andersson, Nilsson, Akenine-Moeller,
 * Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", 2020.
 */
SLUICE_API SluiceResult sluiceComputeFlip(const SluicePicturePair *pPair, float pixelsPerDegree,
                                          const SluiceMetricMap *pMap,
                                          const SluiceAllocationCallbacks *pAllocator,
                                          double *pMean);

/**
 * Colours for values in [0, 1], black through purple and orange to pale yellow: nine samples of the
 * map "magma" and straight lines between them. Values are clamped, NaN is 0. `pColours` is
 * [count][4], RGBA8 sRGB, alpha 255. Errors: NULL_POINTER, unless count is 0. Any thread.
 */
SLUICE_API SluiceResult sluiceColourMagma(const float *pValues, size_t count, uint8_t *pColours);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_METRICS_H */
