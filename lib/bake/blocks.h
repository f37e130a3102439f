/**
 * Encodes blocks: BC1, BC3, BC4 and BC5 through libsquish, ASTC through astcenc, and BC6H and BC7
 * with encoders of our own.
 */
#ifndef SLC_BAKE_BLOCKS_H
#define SLC_BAKE_BLOCKS_H

#include "bake/astc_pool.h"

/** True if this build makes blocks of the format. */
bool slc_can_encode_blocks(SluiceFormat format);

/** Returns the end of a message that says which package this build lacks; "" for other formats. */
const char *slc_block_encoder_hint(SluiceFormat format);

/** Returns the format of texels that blocks are encoded from: RGBA bytes, or halves. */
SluiceFormat slc_block_texel_format(SluiceFormat format);

/** Format and quality of blocks. */
struct slc_block_encoder {
    SluiceFormat format;
    SluiceBakeQuality quality;
    struct slc_astc_pool *astc; ///< NULL is allowed for other formats
};

/**
 * Encodes rows of texels, `pitch` bytes apart, to packed rows of blocks. Texels beyond the right
 * and lower edge do not count. Colors of sRGB formats are compared as they are encoded.
 * Errors: OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_encode_blocks(const struct slc_block_encoder *encoder, const void *texels,
                               size_t pitch, uint32_t width, uint32_t height, void *blocks);

#endif /* SLC_BAKE_BLOCKS_H */
