#include <sluice/metrics.h>

#include "base/checked.h"

#include <math.h>

SluiceResult sluiceComputePsnr8(const uint8_t *pA, const uint8_t *pB, uint32_t width,
                                uint32_t height, uint32_t channelCount, double *pPsnr)
{
    if (!pA || !pB || !pPsnr)
        return SLUICE_ERROR_NULL_POINTER;
    size_t count;
    if (width == 0 || height == 0 || channelCount == 0 || channelCount > 4 ||
        !slc_mul_size(width, height, &count) || !slc_mul_size(count, channelCount, &count))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    /* 2^64 / 255^2 is beyond 2^47 values: more than an address space holds. */
    uint64_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        int32_t difference = (int32_t)pA[i] - pB[i];
        sum += (uint64_t)(difference * difference);
    }
    *pPsnr =
        sum == 0 ? (double)INFINITY : 10.0 * log10(255.0 * 255.0 * (double)count / (double)sum);
    return SLUICE_SUCCESS;
}
