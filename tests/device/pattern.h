/** Procedural textures whose texels identify their positions. */
#ifndef TESTS_DEVICE_PATTERN_H
#define TESTS_DEVICE_PATTERN_H

#include <sluice/image.h>

enum pattern_kind {
    PATTERN_LEVEL, ///< red: (level + 1) / 16, so that 0 is not resident; green and blue: hash of
                   ///< the 64-texel block; alpha 1
    PATTERN_WAVES, ///< smooth, and about the same picture in every level
    PATTERN_HASH,  ///< all channels: hashes of level and texel, k / 255
    PATTERN_SIGNED_HASH ///< all channels: hashes of level and texel, k / 127 - 1
};

struct SluiceImageSource *pattern_source(enum pattern_kind kind, uint32_t width, uint32_t height,
                                         SluiceFormat format);

/** Returns the source's texel before conversion to the format. Not for PATTERN_WAVES. */
void pattern_texel(enum pattern_kind kind, uint32_t level, uint32_t x, uint32_t y, float rgba[4]);

/** Returns the level that a sample of PATTERN_LEVEL shows; -1 if not resident. */
static inline float pattern_level(const float color[4])
{
    return color[0] * 16.0f - 1.0f;
}

/** Tolerance of pattern_level: eight bits give steps of 1/16 level, and half of that. */
#define PATTERN_LEVEL_ERROR 0.035f

/** Returns the tolerance of a fetched channel. */
float pattern_tolerance(SluiceFormat format);
uint32_t pattern_channel_count(SluiceFormat format);

#endif /* TESTS_DEVICE_PATTERN_H */
