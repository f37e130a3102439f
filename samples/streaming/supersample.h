/** Pictures made smaller in linear light. */
#ifndef SAMPLES_STREAMING_SUPERSAMPLE_H
#define SAMPLES_STREAMING_SUPERSAMPLE_H

#include <stdint.h>

struct supersample {
    uint32_t light[256];    ///< of sRGB bytes, 65535 for white
    uint8_t encoded[65536]; ///< and back
};

void supersample_init(struct supersample *tables);

/**
 * Each pixel of `small` [height][width] is the mean of factor x factor of `large`, [height *
 * factor][width * factor]; RGBA, colors sRGB, alpha linear. `factor` from 1 to 16.
 */
void supersample_average(const struct supersample *tables, const uint8_t *large, uint32_t factor,
                         uint32_t width, uint32_t height, uint8_t *small);

#endif /* SAMPLES_STREAMING_SUPERSAMPLE_H */
