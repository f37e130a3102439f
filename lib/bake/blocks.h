/** Blocks from texels: BC1, BC3, BC4 and BC5 through libsquish, BC6H and BC7 by ourselves. */
#ifndef SLC_BAKE_BLOCKS_H
#define SLC_BAKE_BLOCKS_H

#include <sluice/bake.h>

/** Whether this build makes blocks of the format. */
bool slc_can_encode_blocks(SluiceFormat format);

/** What blocks of the format are made from: RGBA bytes, or halves. */
SluiceFormat slc_block_texel_format(SluiceFormat format);

/**
 * Rows of texels, `pitch` bytes apart, to packed rows of blocks. Texels beyond the right and
 * lower edge do not count. Colors of sRGB formats are compared as they are encoded.
 */
void slc_encode_blocks(SluiceFormat format, SluiceBakeQuality quality, const void *texels,
                       size_t pitch, uint32_t width, uint32_t height, void *blocks);

#endif /* SLC_BAKE_BLOCKS_H */
