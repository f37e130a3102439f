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

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_METRICS_H */
