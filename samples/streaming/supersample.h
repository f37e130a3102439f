/** Downscales pictures in linear light. */
#ifndef SAMPLES_STREAMING_SUPERSAMPLE_H
#define SAMPLES_STREAMING_SUPERSAMPLE_H

#include <stdint.h>

struct supersample {
    uint32_t light[256];    ///< linear light by sRGB byte; 65535 is white
    uint8_t encoded[65536]; ///< sRGB byte by linear light
};

void supersample_init(struct supersample *tables);

/**
 * Computes each pixel of `small` [height][width] as the mean of factor x factor pixels of `large`
 * [height * factor][width * factor]. RGBA; colors are sRGB, alpha is linear. `factor`: 1 to 16.
 */
void supersample_average(const struct supersample *tables, const uint8_t *large, uint32_t factor,
                         uint32_t width, uint32_t height, uint8_t *small);

#endif /* SAMPLES_STREAMING_SUPERSAMPLE_H */
