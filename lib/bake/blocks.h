/** Blocks from RGBA bytes: BC1, BC3, BC4 and BC5 through libsquish, BC7 with our own encoder. */
#ifndef SLC_BAKE_BLOCKS_H
#define SLC_BAKE_BLOCKS_H

#include <sluice/bake.h>

/** Whether this build makes blocks of the format. */
bool slc_can_encode_blocks(SluiceFormat format);

/**
 * Rows of RGBA bytes, `pitch` bytes apart, to packed rows of blocks. Texels beyond the right and
 * lower edge do not count. Colours of sRGB formats are compared as they are encoded.
 */
void slc_encode_blocks(SluiceFormat format, SluiceBakeQuality quality, const void *texels,
                       size_t pitch, uint32_t width, uint32_t height, void *blocks);

#endif /* SLC_BAKE_BLOCKS_H */
