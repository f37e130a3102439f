/** BC6H from half floats: all 14 modes. */
#ifndef SLC_BAKE_BC6H_ENCODE_H
#define SLC_BAKE_BC6H_ENCODE_H

#include <sluice/bake.h>

/**
 * Encodes `count` blocks of 16 texels, four halves each, row by row. Writes 16 bytes per block.
 *
 * Alpha is ignored. NaN becomes 0, larger magnitudes become 65504, and negative numbers become 0
 * if `is_signed` is false. The error counts steps between halves, so that dark texels count as much
 * as bright ones. The bytes of a block depend on its texels, `is_signed` and the quality alone.
 * Source: Khronos Data Format Specification 1.3, chapter "BPTC Compressed Texture Image Formats".
 */
void slc_encode_bc6h(bool is_signed, SluiceBakeQuality quality, const uint16_t (*rgba)[64],
                     size_t count, uint8_t *blocks);

#endif /* SLC_BAKE_BC6H_ENCODE_H */
