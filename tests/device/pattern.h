/** Procedural textures whose texels say where they are. */
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

/** What the source gives for a texel, but for PATTERN_WAVES, before it is converted to the format.
 */
void pattern_texel(enum pattern_kind kind, uint32_t level, uint32_t x, uint32_t y, float rgba[4]);

/** The level that a sample of PATTERN_LEVEL shows; -1 where it is not resident. */
static inline float pattern_level(const float color[4])
{
    return color[0] * 16.0f - 1.0f;
}

/** Of pattern_level: eight bits are steps of 1/16 level, half of that off. */
#define PATTERN_LEVEL_ERROR 0.035f

/** How far a fetched channel may be off. */
float pattern_tolerance(SluiceFormat format);
uint32_t pattern_channel_count(SluiceFormat format);

#endif /* TESTS_DEVICE_PATTERN_H */
