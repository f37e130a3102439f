/** Textures of compressed blocks, each of one colour that says where it is. */
#ifndef TESTS_DEVICE_BLOCKS_H
#define TESTS_DEVICE_BLOCKS_H

#include <sluice/image.h>

/** A source whose texels are block_texel's. `format` is a BLOCK one. */
SluiceImageSource *block_source(uint32_t width, uint32_t height, SluiceFormat format);

/** What a decoder makes of a texel, with linear colour. */
void block_texel(SluiceFormat format, uint32_t level, uint32_t x, uint32_t y, float rgba[4]);

/** Decoders may expand endpoints to 8 bits only. */
#define BLOCK_TOLERANCE 0.006f

#endif /* TESTS_DEVICE_BLOCKS_H */
