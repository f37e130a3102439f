/**
 * Conversion of texels of uncompressed formats from and to linear RGBA floats.
 *
 * Halves saturate at +-65504. UNORM is clamped to [0, 1] and SNORM to [-1, 1], and both are rounded
 * to nearest; sRGB formats encode R, G and B. small_float.h has the rules of small floats. NaN
 * becomes 0 in all of these. 32-bit floats are stored unchanged. Integers are rounded to nearest
 * and clamped to their range; NaN becomes 0. Floats hold integers up to 2^24 exactly.
 */
#ifndef SLC_IMAGE_CONVERT_H
#define SLC_IMAGE_CONVERT_H

#include <sluice/image.h>

/** Returns the channels of a format: 1 to 4; 0 for UNDEFINED and compressed formats. */
uint32_t slc_format_channel_count(SluiceFormat format);

/** Returns the nearest of 256 steps; clamps to [0, 1], NaN becomes 0. */
static inline uint8_t slc_unorm8_from_float(float value)
{
    if (!(value > 0.0f))
        return 0;
    /* In double, so that the half that is added cannot round a value up. */
    return value >= 1.0f ? 255 : (uint8_t)((double)value * 255.0 + 0.5);
}

/** Returns the nearest of 65536 steps; clamps to [0, 1], NaN becomes 0. */
static inline uint16_t slc_unorm16_from_float(float value)
{
    if (!(value > 0.0f))
        return 0;
    return value >= 1.0f ? 65535 : (uint16_t)((double)value * 65535.0 + 0.5);
}

/** Converts [count][4] floats to `count` texels. Channels that the format lacks are dropped. */
void slc_texels_from_rgba(SluiceFormat format, const float *rgba, void *texels, size_t count);

/** Converts `count` texels to [count][4] floats. Missing G and B are 0, missing A is 1. */
void slc_texels_to_rgba(SluiceFormat format, const void *texels, float *rgba, size_t count);

#endif /* SLC_IMAGE_CONVERT_H */
