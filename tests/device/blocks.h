/** Textures of compressed blocks, each of one color that says where it is. */
#ifndef TESTS_DEVICE_BLOCKS_H
#define TESTS_DEVICE_BLOCKS_H

#include <sluice/image.h>

/** A source whose texels are block_texel's. `format` is a BLOCK one. */
SluiceImageSource *block_source(uint32_t width, uint32_t height, SluiceFormat format);

/**
 * Range of values that decoders may return for a texel, in linear light. Endpoints may be fractions
 * or widened to 8 bits first. sRGB may be off by half a step of its 8 bits.
 */
struct block_range {
    float low[4], high[4];
};
struct block_range block_texel(SluiceFormat format, uint32_t level, uint32_t x, uint32_t y);

#endif /* TESTS_DEVICE_BLOCKS_H */
